"""Finds the tests that a pattern names.

usage: select_tests.py PATTERN

PATTERN is a regular expression, searched without regard to case in the names of test files without
their ending (tests/kernels/cell_winner_test) and of tests (CellWinner.FindsTheLeast). Prints a line
per folder of tests that holds some: the folder and the filter of GoogleTest that selects them.
"""

import re
import sys
from pathlib import Path

TEST = re.compile(r"^\s*(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
FOLDERS = ("kernels", "scheduler", "engine", "fuzz", "accuracy", "apps")


def suite_filters(suite, test):
    """`test` of `suite`, plain, typed, and of each instantiation with parameters."""
    return [f"{suite}.{test}", f"{suite}/*.{test}", f"*/{suite}.{test}/*", f"*/{suite}/*.{test}/*",
            f"*/{suite}/*.{test}"]


def selected(folder, pattern):
    filters = []
    for file in sorted(Path("tests", folder).rglob("*_test.cc")):
        tests = TEST.findall(file.read_text(encoding="utf-8"))
        if pattern.search(str(file.with_suffix(""))):
            for suite in dict.fromkeys(suite for suite, _ in tests):
                filters += suite_filters(suite, "*")
        else:
            for suite, test in tests:
                if pattern.search(f"{suite}.{test}"):
                    filters += suite_filters(suite, test)
    return filters


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        pattern = re.compile(sys.argv[1], re.IGNORECASE)
    except re.error as error:
        sys.exit(f"'{sys.argv[1]}' is not a regular expression: {error}")
    for folder in FOLDERS:
        if filters := selected(folder, pattern):
            print(folder, ":".join(filters))


main()
