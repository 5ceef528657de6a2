"""Manual pages in roff: vantage(1) and one per command."""
from program import default_text, groups, page_name, usage


def roff(text):
    """`text` with everything escaped that roff would take for a request or an escape."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    text = "".join(letter if letter.isascii() else f"\\[u{ord(letter):04X}]" for letter in text)
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in text.split("\n"))


def option_title(option):
    if option["positional"]:
        return f"\\fI{roff(option.get('value', option['name']))}\\fR"
    names = [f"\\fB{roff('-' + option['short_name'])}\\fR"] if "short_name" in option else []
    names.append(f"\\fB{roff('--' + option['name'])}\\fR")
    value = ""
    if "value" in option:
        breakable = roff(option["value"]).replace("|", "|\\:")
        value = f" \\fI{breakable}\\fR"
    return ", ".join(names) + value


def option_body(option):
    lines = roff(option["help"]).split("\n")
    if default_text(option):
        lines.append(f"Default: {roff(default_text(option))}")
    if "not_with" in option:
        lines.append("Not with " + roff(", ".join(option["not_with"])))
    # Lines of the help are kept apart: some are tables.
    return "\n.br\n".join(line for line in lines if line)


def title(name, version):
    # Flush left without hyphens: lists of choices have no place to break a line evenly.
    return f'.TH {roff(name.upper())} 1 "" "Vantage {version}" "Vantage"\n.ad l\n.nh'


def command_page(command, description):
    lines = [title(page_name(command), description["version"]),
             ".SH NAME", f"{roff(page_name(command))} \\- {roff(command['title'])}",
             ".SH SYNOPSIS", f".B {roff(usage(command))}",
             ".SH DESCRIPTION", roff(command["summary"])]
    for heading, options in groups(command):
        lines.append(f".SH {roff(heading.upper())}")
        for option in options:
            lines += [".TP", option_title(option), option_body(option)]
    if command["examples"]:
        lines += [".SH EXAMPLES", ".nf", *[roff(example) for example in command["examples"]], ".fi"]
    lines += [".SH EXIT STATUS", roff(description["exit_codes"]),
              ".SH SEE ALSO", ".BR vantage (1)"]
    return "\n".join(lines) + "\n"


def program_page(description):
    lines = [title("vantage", description["version"]),
             ".SH NAME", f"vantage \\- {roff(description['summary'])}",
             ".SH SYNOPSIS", ".B vantage", ".I COMMAND", "[OPTIONS]",
             ".SH COMMANDS"]
    for command in description["commands"]:
        lines += [".TP", f".BR {roff(page_name(command))} (1)", roff(command["title"])]
    lines += [".SH EXIT STATUS", roff(description["exit_codes"])]
    return "\n".join(lines) + "\n"


def manual_pages(description):
    """File name → text."""
    pages = {"vantage.1": program_page(description)}
    for command in description["commands"]:
        pages[f"{page_name(command)}.1"] = command_page(command, description)
    return pages
