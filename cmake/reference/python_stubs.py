#!/usr/bin/env python3
"""Writes what the Python package has of the option table: stubs and the documentation of options.

usage: python_stubs.py MODULE SOURCE_DIR PACKAGE_DIR

MODULE is the built _vantage, which says which options each call takes. SOURCE_DIR has vantage/__init__.py
and stubs/*.pyi: signatures, where **options stands for the options and the annotation _Option for the
type of one of them. Their stubs, with options as keywords and with all documentation, go to PACKAGE_DIR,
and the texts of the options to _option_texts.py there.
"""
import ast
import importlib.util
import inspect
import keyword
import pathlib
import re
import sys
import textwrap

COLUMNS = 100
# Type of each kind of value in stubs, and in documentation.
TYPES = {
    "text": ("str", "text"),
    "path": ("_Path", "path"),
    "truth": ("bool", "bool"),
    "integer": ("int", "int"),
    "number": ("float", "float"),
    "numbers": ("float | _Sequence[float] | str", "numbers"),
    "integer_or_text": ("int | str", "int | text"),
    "number_or_text": ("float | str", "float | text"),
    "range": ("tuple[int, int] | str", "(MIN, MAX)"),
    "point": ("tuple[float, float] | str", "(X, Y)"),
    "rectangle": ("tuple[int, int, int, int] | str", "(X, Y, WIDTH, HEIGHT)"),
    "poses": ("_Path | _Sequence[Mapping[str, Any]]", "path | list of dicts"),
}
# Calls that take the options of Matcher but for its range.
OF_OPENCV = ["StereoVantage", "StereoVantage.create", "StereoVantage_create"]


def load_module(path):
    spec = importlib.util.spec_from_file_location("vantage._vantage", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def call_options(module):
    """Call → rows of its options."""
    options = {call: [{**row, "name": row["name"] + "_" * keyword.iskeyword(row["name"])}
                      for row in rows()] for call, rows in module.call_options.items()}
    of_opencv = [row for row in options["Matcher"] if row["name"] != "disparities"]
    return options | dict.fromkeys(OF_OPENCV, of_opencv)


def quoted(word):
    return f'"{word}"'


def kind_of(row):
    return "path" if row["is_path"] and row["kind"] == "text" else row["kind"]


def type_of(row):
    """The annotation of an option."""
    kind = "" if row["kind"] == "word" else TYPES[kind_of(row)][0]
    words = "" if "str" in kind or not row["words"] else f"Literal[{', '.join(map(quoted, row['words']))}]"
    found = " | ".join(part for part in (kind, words) if part)
    return (f"{found} | _Sequence[{found}]" if row["is_list"] else found) + " | None"


def values_of(row):
    """The same in words."""
    kinds = [] if row["kind"] == "word" else [TYPES[kind_of(row)][1]]
    several = ", or a list of them" if row["is_list"] else ""
    return " | ".join(kinds + [quoted(word) for word in row["words"]]) + several


def default_of(row):
    value = row["default"]
    return quoted(value) if isinstance(value, str) else repr(None if value == [] else value)


def text_of_option(row, keywords):
    default = "" if default_of(row) == "None" else f"; default {default_of(row)}"
    head = textwrap.wrap(f"{row['name']}: {values_of(row)}{default}", COLUMNS - 4,
                         initial_indent="  ", subsequent_indent="      ")
    return head + [line for paragraph in row["help"].strip().split("\n")
                   for line in textwrap.wrap(in_python(paragraph, keywords), COLUMNS - 4,
                                             initial_indent="    ", subsequent_indent="    ")]


def in_python(text, keywords):
    """Options of the command line as keywords, where the call has them."""
    def in_place_of(match):
        name = match[1].replace("-", "_")
        name += "_" * keyword.iskeyword(name)
        return name if name in keywords else match[0]
    return re.sub(r"--([a-z][a-z-]*[a-z])", in_place_of, text)


def text_of_options(rows, named):
    """The documentation of the options that the signature does not name."""
    keywords = {row["name"] for row in rows}
    lines, group = ["Options, all by keyword; None is as not given:"], None
    for row in rows:
        if row["name"] in named:
            continue
        if row["group"] != group:
            group = row["group"]
            lines += ["", in_python(group, keywords)]
        lines += text_of_option(row, keywords)
    return "\n".join(lines)


def is_private(name):
    return name.startswith("_") and not name.startswith("__")


def is_of_types(node):
    """Whether a type checker needs a statement: imports for users or of types, names of types, types
    of attributes, __all__, other names of a method."""
    if isinstance(node, ast.Import):
        return any(not is_private(part.asname or part.name) for part in node.names)
    if isinstance(node, ast.ImportFrom):
        return node.module != "__future__"
    return isinstance(node, ast.AnnAssign) or (
        isinstance(node, ast.Assign)
        and isinstance(node.value, (ast.List, ast.BinOp, ast.Name, ast.Subscript)))


def documentation(node, owner):
    """The docstring of a node, or of that member of the owner, if there is one."""
    if owner is None:
        return ast.get_docstring(node) or ""
    text = inspect.getdoc(getattr(owner, node.name, None)) or ""
    is_of_object = node.name.startswith("__")
    return "" if is_of_object else re.sub(rf"^{node.name}\(.*\n*", "", text)  # the signature


class Stub:
    """The stub of a file, made of its syntax tree."""

    def __init__(self, source, options, documented):
        self.options = options        # call → rows
        self.texts = {}               # call → documentation of its options
        self.lines = []
        tree = ast.parse(source)
        self.add_documentation(ast.get_docstring(tree) or "", "")
        for node in tree.body:
            self.add(node, "", documented)

    def text(self):
        return "\n".join(self.lines) + "\n"

    def add(self, node, indent, owner, prefix=""):
        if isinstance(node, ast.If):  # of types
            for part in node.body:
                self.add(part, indent, owner)
        elif isinstance(node, ast.ClassDef) and not is_private(node.name):
            self.add_class(node, owner)
        elif isinstance(node, ast.FunctionDef) and not is_private(node.name):
            if node.returns is not None:  # else it is of object
                self.add_function(node, indent, owner, prefix)
        elif is_of_types(node):
            self.lines.append(indent + ast.unparse(node))

    def add_class(self, node, owner):
        text = documentation(node, owner)
        self.lines += ["", *(f"@{ast.unparse(part)}" for part in node.decorator_list)]
        bases = f"({', '.join(map(ast.unparse, node.bases))})" if node.bases else ""
        self.lines.append(f"class {node.name}{bases}:")
        if text and node.name in self.options:
            text += "\n\n" + self.text_of_options(node.name, node)
        self.add_documentation(text, "    ")
        length = len(self.lines)
        for part in node.body:
            self.add(part, "    ", getattr(owner, node.name, None), node.name + ".")
        if len(self.lines) == length:
            self.lines.append("    ...")

    def add_function(self, node, indent, owner, prefix):
        call = (prefix + node.name).removesuffix(".__init__")
        takes_options = node.args.kwarg is not None and node.args.kwarg.arg == "options"
        text = documentation(node, owner)
        if text and takes_options:
            text += "\n\n" + self.text_of_options(call, node)
        arguments = self.arguments(node, call if takes_options else None)
        self.lines += ["", *(f"{indent}@{ast.unparse(part)}" for part in node.decorator_list)]
        head, tail = f"{indent}def {node.name}(", f") -> {ast.unparse(node.returns)}:"
        one_line = head + ", ".join(arguments) + tail
        if len(one_line) <= COLUMNS:
            self.lines.append(one_line)
        else:
            self.lines += [head, *(f"{indent}    {argument}," for argument in arguments), indent + tail]
        self.add_documentation(text, indent + "    ")
        self.lines.append(indent + "    ...")

    def arguments(self, node, call):
        """The arguments as texts; of a call with options, these in place of **options."""
        given = node.args
        types = {row["name"]: type_of(row) for row in self.options[call]} if call else {}

        def argument(part, default):
            annotation = "" if part.annotation is None else ast.unparse(part.annotation)
            kind = types[part.arg] if annotation == "_Option" else annotation
            return part.arg + (f": {kind}" if kind else "") + (
                f" = {ast.unparse(default)}" if default is not None else "")

        plain = [None] * (len(given.args) - len(given.defaults)) + given.defaults
        texts = [argument(part, default) for part, default in zip(given.args, plain)]
        texts += ["*"] if given.kwonlyargs or call else []
        texts += [argument(part, default) for part, default in zip(given.kwonlyargs, given.kw_defaults)]
        named = names_of(node)
        return texts + [f"{row['name']}: {type_of(row)} = {default_of(row)}"
                        for row in (self.options[call] if call else []) if row["name"] not in named]

    def text_of_options(self, call, node):
        if isinstance(node, ast.ClassDef):
            node = next(part for part in node.body
                        if isinstance(part, ast.FunctionDef) and part.name == "__init__")
        self.texts[call] = text_of_options(self.options[call], names_of(node))
        return self.texts[call]

    def add_documentation(self, text, indent):
        if text:
            lines = text.replace("\\", "\\\\").split("\n")
            self.lines += [f'{indent}"""{lines[0]}', *(indent + line if line else ""
                                                       for line in lines[1:])]
            self.lines[-1] += '"""' if len(lines) == 1 else ""
            self.lines += [] if len(lines) == 1 else [f'{indent}"""']


def names_of(function):
    return {part.arg for part in function.args.args + function.args.kwonlyargs}


def write(path, text):
    if not path.is_file() or path.read_text() != text:
        path.write_text(text)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    module = load_module(pathlib.Path(sys.argv[1]).resolve())
    source, package = map(pathlib.Path, sys.argv[2:])
    options = call_options(module)
    texts = {}
    for file, documented in ((source / "vantage/__init__.py", None),
                             (source / "stubs/_vantage.pyi", module), (source / "stubs/opencv.pyi", None)):
        stub = Stub(file.read_text(), options, documented)
        write(package / (file.stem + ".pyi"), stub.text())
        texts |= {} if documented else stub.texts
    write(package / "_option_texts.py",
          f'"""The documentation of the options of each call."""\n\nTEXTS = {texts!r}\n')


if __name__ == "__main__":
    main()
