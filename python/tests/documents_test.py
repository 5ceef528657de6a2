"""The stubs say what is in the bindings, and all of the module has a docstring."""

import ast
import inspect
from pathlib import Path

import vantage
import vantage.opencv

SOURCE = Path(__file__).parent.parent
# What is written in Python.
OF_THE_PACKAGE = {name for name in vantage.__all__
                  if getattr(vantage, name) is not getattr(vantage._vantage, name, None)}


def arguments_of(definition):
    """Name, kind and whether there is a default, of each parameter of a function's syntax tree."""
    given = definition.args
    plain = given.posonlyargs + given.args
    defaults = [False] * (len(plain) - len(given.defaults)) + [True] * len(given.defaults)
    found = [(part.arg, "plain", has) for part, has in zip(plain, defaults)]
    found += [("", "list", False)] if given.vararg else []
    found += [(part.arg, "keyword", value is not None)
              for part, value in zip(given.kwonlyargs, given.kw_defaults)]
    return found + ([("", "keywords", False)] if given.kwarg else [])


def arguments_in_force(binding):
    """The same of a binding, which says its signature in its docstring."""
    signature = (binding.__doc__ or "").partition(" -> ")[0]
    return arguments_of(ast.parse(f"def {signature}: ...").body[0])


def is_public(name):
    return not name.startswith("_") or name in ["__init__", "__call__", "__iter__", "__len__"]


def public_names(module):
    return {name for name, value in vars(module).items()
            if not name.startswith("_") and (inspect.isclass(value) or callable(value))}


def test_stubs_say_what_the_bindings_have():
    stub = ast.parse((SOURCE / "stubs/_vantage.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    assert {*classes} == {*vantage.__all__} - OF_THE_PACKAGE
    for name, node in classes.items():
        known = getattr(vantage, name)
        assert known.__doc__, name
        if issubclass(known, Exception):
            continue
        members = {part.name: part for part in node.body if isinstance(part, ast.FunctionDef)}
        own = {member for member in vars(known) if is_public(member)}
        own -= set() if "__init__" in members else {"__init__"}  # only the module makes them
        assert own == {*members}, name
        for member, part in members.items():
            value = getattr(known, member)
            if isinstance(value, property):
                assert value.__doc__, (name, member)
            elif member != "__len__":
                assert arguments_in_force(value) == arguments_of(part), (name, member)
                assert value.__doc__ or member.startswith("__"), (name, member)


def test_the_class_for_opencv_has_docstrings():
    for name, value in vars(vantage.opencv.StereoVantage).items():
        assert value.__doc__ or not inspect.isfunction(value) or name.startswith("_"), name


def test_the_package_says_its_types():
    assert public_names(vantage) == set(vantage.__all__)
    for name in OF_THE_PACKAGE:
        known = getattr(vantage, name)
        assert known.__doc__, name
        members = [known] if not inspect.isclass(known) else [
            value.fget if isinstance(value, property) else value
            for member, value in vars(known).items()
            if is_public(member) and (callable(value) or isinstance(value, property))]
        for function in members:
            annotations = dict(function.__annotations__)
            names = set(inspect.signature(function).parameters) - {"self"}
            is_made_here = name in ["Volume", "Frame", "RectifiedImages"]  # not by users
            assert names <= {*annotations} or is_made_here, (name, function)
            assert function.__doc__ or function.__name__.startswith("__"), (name, function)
