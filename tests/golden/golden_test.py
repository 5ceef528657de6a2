#!/usr/bin/env python3
"""Results of every method, preset and command that makes maps or views, by checksum: a change of
results is a decision, made with --update and explained in its commit.

usage: golden_test.py VANTAGE [--update]

golden.txt beside this file holds one command in each paragraph and, below it, the files that it
writes, each with the first 16 digits of its SHA-256, and with a processor where others give other
bits. Commands run in order in one folder, on one to three threads in turn, and every other one on
the least instruction set: neither changes a result."""

import argparse
import hashlib
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

GOLDEN = Path(__file__).with_name("golden.txt")
# Words that several commands share. Sizes are odd, and no multiple of a vector.
WORDS = {
    "PAIR": "scene/left.png scene/right.png",
    "FRAMES": "--left film/left --right film/right",
    "RANGE": "--disparities 1:17",
    "WITHOUT_WINDOWS": "--preset balanced --census-thresholds 1 --iterations 2 --final-iterations 0"
                       " --window-levels 0",
}


def paragraphs():
    """The commands of golden.txt, each with {file and processor: checksum}."""
    for text in GOLDEN.read_text(encoding="utf-8").split("\n\n"):
        lines = [line for line in text.splitlines() if line and not line.startswith("#")]
        if lines:
            yield lines[0], {file: digits for digits, file in
                             (line.split(maxsplit=1) for line in lines[1:])}


def build_of(program):
    """Its processor and least instruction set."""
    said = subprocess.run([program, "--version", "--verbose"], capture_output=True, text=True,
                          check=True).stdout
    return (re.search("system .* (.*)", said)[1],
            re.search("available here +(.*)", said)[1].split()[-1])


def run(program, command, index, instruction_set):
    words = []
    for word in shlex.split(command):
        words += WORDS[word].split() if word in WORDS else [word]
    if words[0] != "generate":
        words += ["--threads", str(1 + index % 3), "--isa", instruction_set, "--quiet"]
    done = subprocess.run([program, *words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return f"exit code {done.returncode}: {done.stderr.strip()}"
    return None


def checksum(file):
    path = Path(file)
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16] if path.is_file() else "missing"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--update", action="store_true", help="write the checksums of this program")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    header = "\n".join(line for line in GOLDEN.read_text(encoding="utf-8").splitlines()
                       if line.startswith("#"))
    updated, failures, files = [header], 0, 0
    processor, least_instruction_set = build_of(program)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for index, (command, expected) in enumerate(paragraphs()):
            error = run(program, command, index, ["best", least_instruction_set][index % 2])
            seen = {file: checksum(*file.split()[:1]) for file in expected
                    if file.split()[1:] in ([], [processor])}
            lines = {**expected, **seen}
            updated.append("\n".join([command, *(f"  {lines[file]} {file}" for file in lines)]))
            wrong = [file for file in seen if seen[file] != expected[file]]
            files += len(seen)
            if error or (wrong and not arguments.update):
                failures += 1
                print(f"vantage {command}: {error or 'differs: ' + ', '.join(wrong)}")
        os.chdir("/")
    if arguments.update and failures == 0:
        GOLDEN.write_text("\n\n".join(updated) + "\n", encoding="utf-8")
    print(f"{len(updated) - 1} commands, {files} files, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
