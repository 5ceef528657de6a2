"""Adds up the outcome of every test of one build.

usage: count_tests.py RESULTS.xml REPORTS

RESULTS.xml is ctest's JUnit file. Tests that share a process are one test to ctest, whose name holds
"/shard-": theirs are the reports of GoogleTest, REPORTS/NAME.xml. Prints how many passed, failed and
were skipped.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def outcome(test):
    if test.find("failure") is not None or test.get("status") == "fail":
        return "failed"
    if test.find("skipped") is not None or test.get("status") in ("notrun", "disabled"):
        return "skipped"
    return "passed"


def main():
    results, reports = sys.argv[1:]
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for test in ElementTree.parse(results).getroot().iter("testcase"):
        name = test.get("name")
        report = Path(reports) / f"{name}.xml"
        if "/shard-" not in name:
            counts[outcome(test)] += 1
            continue
        outcomes = []
        if report.exists():
            outcomes = [outcome(one) for one in ElementTree.parse(report).getroot().iter("testcase")]
        for one in outcomes:
            counts[one] += 1
        # The process ended before its last test, or badly after it.
        if outcome(test) == "failed" and "failed" not in outcomes or not outcomes:
            counts["failed"] += 1
    print(counts["passed"], counts["failed"], counts["skipped"])


main()
