"""What type checkers and editors know: every option, its type and its words."""

import ast
import inspect
import json
import os
import re
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

import vantage
from conftest import run_program

FOLDER = Path(vantage.__file__).parent
SOURCE = Path(__file__).parent.parent
CASES = Path(__file__).parent / "typed"


def keywords_of(stub, call):
    """The arguments of a function or class of a stub."""
    body = ast.parse((FOLDER / f"{stub}.pyi").read_text()).body
    for name in call.split("."):
        node = next(part for part in body if getattr(part, "name", "") == name)
        body = getattr(node, "body", [])
    if isinstance(node, ast.ClassDef):
        node = next(part for part in body if getattr(part, "name", "") == "__init__")
    return {part.arg for part in node.args.args + node.args.kwonlyargs} - {"self"}


def complaint(take, name):
    with pytest.raises((vantage.UsageError, vantage.Error)) as caught:
        take(**{name: object()})
    return str(caught.value)


def calls(pair):
    """Stub and name of each call that takes options, the call itself, and its other arguments."""
    left, right = pair
    result = vantage.Matcher(disparities=(0, 15)).compute(left, right)
    rig = {"focal_length": 9, "baseline": 1}
    images = {"left", "right", "disparity", "image", "calibration", "unmatched", "confidence", "bgr",
              *rig}
    yield "__init__", "Matcher", vantage.Matcher, {"unrectified", "rectified_pixels"}
    yield ("__init__", "Sequence", lambda **options: vantage.Sequence("a", "b", **options),
           {"left", "right", "pairs", "frames", "calibration", "unrectified", "save", "bgr"})
    yield ("__init__", "synthesize", lambda **options: vantage.synthesize(left, right, **options),
           images | {"right_disparity", "view"} - {*rig})
    yield ("__init__", "rectify", lambda **options: vantage.rectify(left, right, **options),
           images | {"kept_outline"} - {*rig})
    yield "__init__", "read_image", lambda **options: vantage.read_image("no.png", **options), {"path"}
    cameras = vantage.Calibration.from_focal_length(9, 1, image_size=(160, 120))
    yield ("__init__", "reproject",
           lambda **options: vantage.reproject(result.disparity, cameras, **options), images)
    for name in ["depth", "depth_resolution", "disparity", "cloud", "mesh"]:
        given = [result.disparity] + [left] * (name in ["cloud", "mesh"])
        yield ("__init__", name, partial(getattr(vantage, name), *given, **rig), images | {"depth"})
        if name != "disparity":
            yield "_vantage", f"MatchResult.{name}", partial(getattr(result, name), **rig), images


def test_stubs_have_each_option_that_a_call_knows(pair):
    of_program = {option["name"].replace("-", "_") for command in ["match", "run", "synth"]
                  for option in json.loads(run_program(command, "--help-json").stdout)["options"]}
    refused = {"already_rectified", "raw_video"}  # with another message
    other_words = {"lambda"}  # lambda_
    for stub, call, take, others in calls(pair):
        shown = keywords_of(stub, call)
        for name in (of_program | shown) - others - refused - other_words:
            assert ("unknown option" in complaint(take, name)) == (name not in shown), (call, name)


def test_built_stubs_are_of_this_module(tmp_path):
    subprocess.run([sys.executable, "-B", SOURCE.parent / "cmake/reference/python_stubs.py",
                    vantage._vantage.__file__, SOURCE, tmp_path], check=True)
    made = sorted(file.name for file in tmp_path.iterdir())
    assert made == ["__init__.pyi", "_option_texts.py", "_vantage.pyi", "opencv.pyi"]
    for name in made:
        assert (tmp_path / name).read_text() == (FOLDER / name).read_text(), name


def test_help_says_what_stubs_have():
    for call in ["Matcher", "Sequence", "synthesize", "cloud", "read_image"]:
        known = getattr(vantage, call)
        for name in keywords_of("__init__", call) - {*inspect.signature(known).parameters}:
            assert f"\n  {name}: " in inspect.getdoc(known), (call, name)


def checked(*arguments):
    """Output of a module of mypy's, which knows the package as it was built."""
    pytest.importorskip("mypy", reason="no mypy")
    environment = {**os.environ, "MYPYPATH": str(FOLDER.parent)}
    return subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True,
                          env=environment, cwd=CASES).stdout


def test_type_checkers_accept_right_calls_and_refuse_wrong_ones(tmp_path):
    report = checked("mypy", "--strict", f"--cache-dir={tmp_path}", "right_calls.py", "wrong_calls.py")
    found = set(re.findall(r"^(.*):(\d+): error", report, re.M))
    lines = (CASES / "wrong_calls.py").read_text().splitlines()
    assert found == {("wrong_calls.py", str(number)) for number, line in enumerate(lines, 1)
                     if "# wrong" in line}, report


def test_stubs_are_of_what_runs(tmp_path):
    of_bindings = r"""vantage\._vantage\..*
vantage\.(Calibration|MatchResult|Mesh|PointCloud)(\.__init__)?"""  # another test is of them
    (tmp_path / "allowed").write_text(of_bindings)
    report = checked("mypy.stubtest", "vantage", "--allowlist", tmp_path / "allowed")
    assert report.startswith("Success"), report


def test_editors_complete_options():
    jedi = pytest.importorskip("jedi", reason="no jedi")
    project = jedi.Project(FOLDER.parent, added_sys_path=[str(FOLDER.parent)])
    for start in ["vantage.Matcher(surface_fi", "vantage.Sequence(temporal_pr"]:
        found = jedi.Script(f"import vantage\n{start}", project=project).complete()
        assert any(name.name.startswith(start.partition("(")[2]) for name in found), start
