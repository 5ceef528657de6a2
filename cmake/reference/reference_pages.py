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
    return f"| {name} | {inline(option['help'])}{required} | {default} |"


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
         "prints the same.", "", "| command | what it does |", "|---|---|", *rows, ""])
    return pages
