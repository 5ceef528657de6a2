"""Every block of docs/python.md runs, in order, beside a generated pair; every block of the stubs is
of the module."""

import ast
import os
import re
from pathlib import Path

import pytest
from conftest import run_program

import vantage
import vantage.opencv

ROOT = Path(__file__).parents[2]


def test_tutorial(tmp_path, monkeypatch):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.S)
    assert len(blocks) >= 8
    assert len(blocks[0].strip().splitlines()) == 5  # pair in, coloured map out
    run_program("generate", "scene", "-o", tmp_path, "--frames", 3, "--width", 96, "--height", 64,
                "--quiet")
    run_program("generate", "scene", "-o", tmp_path, "--width", 200, "--height", 150, "--quiet")
    monkeypatch.chdir(tmp_path)
    names = {}
    for number, block in enumerate(blocks, 1):
        exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
    assert os.path.getsize("map.png") > 0


@pytest.mark.parametrize("module", [vantage, vantage.opencv], ids=lambda module: module.__name__)
def test_stubs_name_what_there_is(module):
    stub = ast.parse(Path(module.__file__).with_suffix(".pyi").read_text())
    named = {}
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            members = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
            named[node.name] = members
        elif isinstance(node, ast.FunctionDef):
            named[node.name] = set()
    for name in named:
        assert hasattr(module, name)
        public = {member for member in vars(getattr(module, name)) if not member.startswith("_")}
        if isinstance(getattr(module, name), type) and not issubclass(getattr(module, name),
                                                                      Exception):
            assert public - {"compute"} <= named[name] | {"compute"}
            assert named[name] <= {"__init__", "__call__", "__iter__", "__len__"} | public
    assert set(getattr(module, "__all__", named)) <= set(named)
