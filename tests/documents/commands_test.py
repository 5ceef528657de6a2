#!/usr/bin/env python3
"""Runs the shell and Python blocks of the documents, so that what they tell users to type works.

usage: commands_test.py VANTAGE [PYTHON_FOLDER] [--only DOCUMENT] [--verbose]

A document is read as by a newcomer: its blocks run in order in one folder, which is empty at first,
so it must name whatever it needs. Python blocks share their names; PYTHON_FOLDER holds the module
(without it, or where no interpreter can load it, they are left out). Three comments before a block
say otherwise:

    <!-- not run: REASON -->         the block is left out
    <!-- needs: PROGRAM -->          the block is left out where there is no PROGRAM
    <!-- data of yours: NAME -->     a reader of the block has NAME; a small one is made (STAND_INS)

Options that the text or a block that is not run names must be options of the program: of the command
where one is named, too (`scene build --grid`). Prints each block that fails and each such option,
with its place, and exits 1 when there is one.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "tests/depths"), str(ROOT / "tests/asp"), str(ROOT / "cmake/reference")]
from plain_readers import read_png  # noqa: E402
from plain_tiff import write_tiff  # noqa: E402
from program import read_program  # noqa: E402

DOCUMENTS = ["README.md", "CONTRIBUTING.md", "perf/README.md",
             *sorted(f"docs/{file.name}" for file in (ROOT / "docs").glob("*.md"))]
FENCE = re.compile(r"^```(\w*)\s*$")
COMMENT = re.compile(r"<!-- (not run|needs|data of yours): (.+) -->")

# Runs blocks of Python that share their names; one JSON text a line in, the last line of the error
# or null out.
PYTHON_SESSION = """
import json, os, sys, traceback
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
names = {"__name__": "__main__"}
for line in sys.stdin:
    error = None
    try:
        exec(compile(json.loads(line), "block", "exec"), names)
    except BaseException:
        error = traceback.format_exc().strip().splitlines()[-1]
    print(json.dumps(error), file=answers, flush=True)
"""


def is_run(comment):
    kind, value = comment.groups() if comment else ("", "")
    return kind != "not run" and not (kind == "needs" and not shutil.which(value))


def blocks(text):
    """Line number, language, text and data of the reader's, of each block that is run."""
    block, start, language, before = None, 0, "", ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if block is not None and line.startswith("```"):
            comment = COMMENT.search(before)
            if language in ("sh", "python") and is_run(comment):
                has_data = comment and comment.group(1) == "data of yours"
                yield start, language, "\n".join(block), comment.group(2) if has_data else None
            block, before = None, ""
        elif block is not None:
            block.append(line)
        elif fence:
            block, start, language = [], number + 1, fence.group(1)
        elif line.strip():
            before = line


def kitti_file(calib):
    """KITTI's calib_cam_to_cam.txt of Middlebury's calib.txt of a rectified rig; the grey cameras are a
    little farther apart."""
    values = dict(line.split("=") for line in calib.splitlines())
    focal, _, cx, _, _, cy = [float(n) for n in re.findall(r"[-.\d]+", values["cam0"])[:6]]
    text = "calib_time: 09-Jan-2012 13:57:47\n"
    for camera, baseline_m in enumerate([0, 0.54, 0, 0.53]):
        text += (f"P_rect_0{camera}: {focal} 0 {cx} {-focal * baseline_m} "
                 f"0 {focal} {cy} 0 0 0 1 0\n")
    return text


def make_kitti(pair, vantage, target):
    for folder, name in (("image_2", "left.png"), ("image_3", "right.png")):
        (target / folder).mkdir(parents=True)
        shutil.copy(pair / name, target / folder / "000000_10.png")
    (target / "disp_occ_0").mkdir()
    vantage(f"match {pair}/left.png {pair}/right.png -o {target}/disp_occ_0/000000_10.png")
    (target / "calib_cam_to_cam").mkdir()
    (target / "calib_cam_to_cam/000000.txt").write_text(
        kitti_file((pair / "calib.txt").read_text()))


def make_tiles(pair, vantage, target):
    target.mkdir()
    for side in ("left", "right"):
        write_tiff(target / f"{side}.tif", [[float(pixel[0]) for pixel in row]
                                            for row in read_png(pair / f"{side}.png")])


# Data that only a reader has: folder → what makes a small one.
STAND_INS = {"training": make_kitti, "tiles": make_tiles}

# Documents with options of other programs.
OF_DEVELOPERS = {"CONTRIBUTING.md", "docs/ARCHITECTURE.md", "perf/README.md"}


def options_of_commands(program):
    """Name of a command → its options; "": those of all."""
    options = {command["name"]: {"help", "help-all", *(option["name"] for option in command["options"])}
               for command in read_program(program)["commands"]}
    return {**options, "": set().union(*options.values())}


def named_commands(text):
    """Line number and text of what looks like a command or an option, outside of blocks that are run."""
    run = {line + k for line, _, block, _ in blocks(text) for k in range(len(block.splitlines()))}
    is_block = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            is_block = not is_block
        elif number not in run:
            for part in line.split("|") if is_block else re.findall(r"`([^`]*)`", line):
                yield number, part


def wrong_options(document, text, options):
    for number, part in named_commands(text):
        part = part.strip()
        words = part.removeprefix("vantage ").split()
        command = next((name for name in sorted(options, key=len, reverse=True)
                        if words[:len(name.split())] == name.split()), "")
        if command or part.startswith("--"):
            for name in re.findall(r"(?<![\w-])--([a-z][a-z-]*)", part):
                if name not in options[command]:
                    yield f"{document}:{number}: {command or 'the program'} has no option --{name}"


class Reader:
    """Who types what a document says, in an empty folder."""

    def __init__(self, program, python, folder):
        self.program = program
        self.python = python  # interpreter and its environment, or None
        self.folder = folder
        self.session = None
        self.environment = dict(os.environ, TERM="dumb",
                                PATH=f"{pathlib.Path(program).parent}:{os.environ['PATH']}")
        folder.mkdir()

    def has(self, name):
        """Makes the data `name`."""
        def vantage(words):
            subprocess.run([self.program, *words.split(), "--quiet"], check=True)
        with tempfile.TemporaryDirectory() as pair:
            vantage(f"generate scene --width 192 --height 144 --near 14 -o {pair}")
            STAND_INS[name](pathlib.Path(pair), vantage, self.folder / name)

    def run_shell(self, block):
        """What went wrong, or None."""
        result = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=self.folder, text=True,
                                env=self.environment, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        if result.returncode != 0:
            last_lines = "\n    ".join(result.stdout.strip().splitlines()[-3:])
            return f"exit {result.returncode}\n    {last_lines}"
        return None

    def run_python(self, block):
        if self.python is None:
            return None
        if self.session is None:
            interpreter, environment = self.python
            self.session = subprocess.Popen(
                [interpreter, "-B", "-c", PYTHON_SESSION], cwd=self.folder, text=True,
                env={**self.environment, **environment}, stdin=subprocess.PIPE,
                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.session.stdin.write(json.dumps(block) + "\n")
        self.session.stdin.flush()
        return json.loads(self.session.stdout.readline() or '"Python ended"')

    def leave(self):
        if self.session:
            self.session.stdin.close()
            self.session.wait()


def run_document(program, python, document, work, verbose):
    """The blocks that failed, as texts."""
    reader = Reader(program, python, work / document.replace("/", "-"))
    failures = []
    for line, language, block, data in blocks((ROOT / document).read_text()):
        if data:
            reader.has(data)
        start = time.monotonic()
        problem = reader.run_shell(block) if language == "sh" else reader.run_python(block)
        if verbose:
            print(f"{document}:{line}: {problem or 'ok'}, {time.monotonic() - start:.1f} s")
        if problem:
            failures.append(f"{document}:{line}: {problem}")
    reader.leave()
    return failures


def find_python(folder):
    """An interpreter that loads the module in `folder`, and its environment."""
    environment = {"PYTHONPATH": str(folder)}
    for interpreter in (sys.executable, "/usr/bin/python3"):
        if folder and subprocess.run([interpreter, "-B", "-c", "import vantage, cv2"],
                                     env={**os.environ, **environment},
                                     stderr=subprocess.DEVNULL).returncode == 0:
            return interpreter, environment
    print("no Python module: its blocks are left out")
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("python", nargs="?", type=os.path.abspath)
    parser.add_argument("--only")
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    documents = [document for document in DOCUMENTS
                 if arguments.only in (None, document)]
    program = os.path.abspath(arguments.program)
    python = find_python(arguments.python)
    options = options_of_commands(program)
    failures = [problem for document in documents if document not in OF_DEVELOPERS
                for problem in wrong_options(document, (ROOT / document).read_text(), options)]
    with tempfile.TemporaryDirectory() as work:
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            failures += sum(pool.map(lambda document: run_document(
                program, python, document, pathlib.Path(work), arguments.verbose), documents), [])
    for failure in failures:
        print(failure)
    print(f"commands of documents: {len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
