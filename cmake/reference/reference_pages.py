"""Reference pages in Markdown, one per command."""
import html

from program import default_text, groups, page_name, usage


def inline(text):
    """`text` in a cell of a table."""
    escaped = text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")
    return escaped.replace("*", "\\*").replace("_", "\\_").replace("\n", "<br>")


def code(text):
    return "<code>" + html.escape(text, quote=False).replace("|", "&#124;") + "</code>"


def option_row(option):
    if option["positional"]:
        name = code(option.get("value", option["name"]))
    else:
        short = f"-{option['short_name']}, " if "short_name" in option else ""
        value = f" {option['value']}" if "value" in option else ""
        name = code(f"{short}--{option['name']}{value}")
    default = code(default_text(option)) if default_text(option) else ""
    required = " (required)" if option["required"] else ""
    others = ", ".join(code(other) for other in option.get("not_with", []))
    not_with = f"<br>Not with {others}" if others else ""
    return f"| {name} | {inline(option['help'])}{required}{not_with} | {default} |"


def combinations_page(rows):
    """What does not go together, and why; rows of one option and reason are joined."""
    joined = {}
    for row in rows:
        key = "not_with" if "not_with" in row else "only_with"
        place = joined.setdefault((row["option"], key, row["reason"]), [[], False])
        place[0] += [code(text) for text in row[key] if code(text) not in place[0]]
        place[1] = place[1] or row["preset_gives_way"]
    lines = ["# Options that do not go together", "",
             "A command refuses them with one line that says why. Where a preset's value gives way, "
             "only what you set yourself is refused.", "",
             "| option | goes | because | preset gives way |", "|---|---|---|---|"]
    for (option, key, reason), (others, gives_way) in joined.items():
        goes = ("not with " if key == "not_with" else "only with ") + ", ".join(others)
        lines.append(f"| {code(option)} | {goes} | {inline(reason)} | {'yes' if gives_way else ''} |")
    return "\n".join([*lines, ""])


def command_page(command, exit_codes):
    lines = [f"# vantage {command['name']}", "", inline(command["summary"]), "",
             "```text", usage(command), "```", ""]
    if command["examples"]:
        lines += ["## Examples", "", "```text", *command["examples"], "```", ""]
    for heading, options in groups(command):
        lines += [f"## {heading}", "", "| option | meaning | default |", "|---|---|---|"]
        lines += [option_row(option) for option in options] + [""]
    return "\n".join(lines + ["## Exit status", "", exit_codes, ""])


def reference_pages(description):
    """File name → text."""
    pages = {f"{page_name(command)}.md": command_page(command, description["exit_codes"])
             for command in description["commands"]}
    rows = [f"| [vantage {command['name']}]({page_name(command)}.md) | {command['title']} |"
            for command in description["commands"]]
    pages["index.md"] = "\n".join(
        ["# Commands", "", f"Of Vantage {description['version']}; `vantage COMMAND --help-all` "
         "prints the same. What does not go together is [one table](combinations.md).", "", "| command | what it does |", "|---|---|", *rows, ""])
    pages["combinations.md"] = combinations_page(description["combinations"])
    return pages
