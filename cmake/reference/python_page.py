#!/usr/bin/env python3
"""Writes the page of the Python module for the site, from docstrings and the option table.

usage: python_page.py MODULE SOURCE_DIR PAGE    as of python_stubs.py
"""
import ast
import pathlib
import re
import sys

import python_stubs

HEAD = """# Python reference

All of the module `vantage`; the [tutorial](python.md) shows how it is used. Options are keyword
arguments; None is as not given.
"""


def escaped(text):
    """Text of a docstring as Markdown."""
    return re.sub(r"([*_<>\[\]|])", r"\\\1", text)


def paragraphs(text):
    """A docstring as Markdown: what describes an argument is an item of a list."""
    lines, in_list = [], False
    for line in text.split("\n"):
        item = re.match(r"(\w+(?:, \w+)*): (.*)", line)
        if item:
            lines += ([] if in_list else [""]) + [f"- **{escaped(item[1])}**: {escaped(item[2])}"]
        else:
            lines.append(("  " if in_list and line else "") + escaped(line))
        in_list = bool(item) or (in_list and bool(line))
    return "\n".join(lines)


def table(rows, keywords):
    """The options of a group."""
    lines = ["| option | values | default | |", "|---|---|---|---|"]
    for row in rows:
        default = python_stubs.default_of(row)
        text = escaped(python_stubs.in_python(row["help"].strip(), keywords)).replace("\n", "<br>")
        lines.append(f"| `{row['name']}` | {escaped(python_stubs.values_of(row))} | "
                     f"{'' if default == 'None' else escaped(default)} | {text} |")
    return lines


def options(rows, named, of_matcher):
    """The options that a signature does not name, by group; those of Matcher by a link."""
    keywords = {row["name"] for row in rows}
    rows = [row for row in rows if row["name"] not in named]
    groups, lines = {}, []
    for row in rows:
        if row not in of_matcher:
            groups.setdefault(row["group"], []).append(row)
    for group, members in groups.items():
        lines += ["", f"*{escaped(python_stubs.in_python(group, keywords))}*", "",
                  *table(members, keywords)]
    shared = [f"`{row['name']}`" for row in rows if row in of_matcher]
    return lines + (["", f"As of [Matcher](#matcher): {', '.join(shared)}."] if shared else [])


class Page:
    def __init__(self, calls):
        self.calls = calls  # call → rows
        self.lines = [HEAD]

    def add(self, node, owner, prefix=""):
        if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or node.name.startswith("_"):
            return
        members = node.body if isinstance(node, ast.ClassDef) else []
        made_by = [part for part in members if getattr(part, "name", "") == "__init__"]
        decorators = [ast.unparse(part) for part in node.decorator_list]
        function = node if not members else made_by[0] if made_by else None
        name = prefix + node.name
        self.lines.append(f"\n{'###' if prefix else '##'} {name}\n")
        if function is not None and "property" not in decorators:
            for part in ast.walk(function.args):
                if isinstance(part, ast.arg):
                    part.annotation = None
            arguments = re.sub(r"^self(, )?", "", ast.unparse(function.args))
            self.lines.append(f"```python\nvantage.{name}({arguments})\n```\n")
        self.lines.append(paragraphs(python_stubs.documentation(node, owner)))
        if name in self.calls:
            self.lines += options(self.calls[name], python_stubs.names_of(function),
                                  [] if name == "Matcher" else self.calls["Matcher"])
        for part in members:
            self.add(part, getattr(owner, node.name, None), node.name + ".")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    module = python_stubs.load_module(pathlib.Path(sys.argv[1]).resolve())
    source, out = map(pathlib.Path, sys.argv[2:])
    page = Page(python_stubs.call_options(module))
    for file, owner in ((source / "vantage/__init__.py", None), (source / "stubs/_vantage.pyi", module)):
        for node in ast.parse(file.read_text()).body:
            page.add(node, owner)
    out.parent.mkdir(parents=True, exist_ok=True)
    python_stubs.write(out, "\n".join(page.lines) + "\n")


if __name__ == "__main__":
    main()
