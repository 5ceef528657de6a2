"""Arithmetic and behaviour of perf/compare: figures from every form of JSON, order of the runs,
medians, ranges, ratios, verdicts, and what it says when a command fails."""

import importlib.machinery
import importlib.util
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

COMPARE = Path(__file__).parent.parent / "perf" / "compare"

loader = importlib.machinery.SourceFileLoader("compare", str(COMPARE))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)


class Arithmetic(unittest.TestCase):
    def test_medians_ranges_and_ratios_round_by_round(self):
        # Medians 4 and 6; ratios 3, 1.5, 0.6: their median is not that of the medians.
        result = compare.compared([2, 4, 10], [6, 6, 6])
        self.assertEqual(result["a_seconds"], {"median": 4, "least": 2, "most": 10})
        self.assertEqual(result["b_seconds"], {"median": 6, "least": 6, "most": 6})
        self.assertEqual(result["ratio"], {"median": 1.5, "least": 0.6, "most": 3})

    def test_a_verdict_needs_ranges_that_are_apart(self):
        verdict = lambda first, second: compare.compared(5 * first, 5 * second)["verdict"]
        self.assertEqual(verdict([3, 4], [1, 2]), "B is faster")
        self.assertEqual(verdict([1, 2], [3, 4]), "A is faster")
        self.assertEqual(verdict([1, 3], [2, 4]), "")
        self.assertEqual(verdict([1, 2], [2, 3]), "")  # they touch
        self.assertEqual(verdict([2, 3], [1, 2]), "")
        self.assertEqual(verdict([1, 9], [2, 3]), "")  # one within the other

    def test_a_verdict_needs_rounds(self):
        self.assertEqual(compare.compared([1] * 4, [2] * 4)["verdict"], "")
        self.assertEqual(compare.compared([1] * 5, [2] * 5)["verdict"], "A is faster")

    def test_times_of_nothing_have_no_ratio(self):
        self.assertIsNone(compare.compared([0, 0], [0, 0])["ratio"])


class Figures(unittest.TestCase):
    def test_google_benchmark(self):
        document = {"benchmarks": [
            {"name": "a", "run_type": "iteration", "real_time": 5, "time_unit": "ns"},
            {"name": "a", "run_type": "iteration", "real_time": 9, "time_unit": "ns"},
            {"name": "a", "run_type": "iteration", "real_time": 6, "time_unit": "ns"},
            {"name": "a_mean", "run_type": "aggregate", "real_time": 7, "time_unit": "ns"},
            {"name": "b", "run_type": "iteration", "real_time": 2, "time_unit": "ms"}]}
        figures = compare.figures_in_seconds(document)
        self.assertEqual(set(figures), {"a", "b"})
        self.assertAlmostEqual(figures["a"], 6e-9)
        self.assertAlmostEqual(figures["b"], 2e-3)

    def test_tables(self):
        table = {"title": "t", "rows": [{"name": "x", "median_seconds": 0.5}]}
        other = {"title": "u", "rows": [{"name": "x", "median_seconds": 0.25}]}
        self.assertEqual(compare.figures_in_seconds([table]), {"x": 0.5})
        self.assertEqual(compare.figures_in_seconds(table), {"x": 0.5})
        self.assertEqual(compare.figures_in_seconds([table, other]), {"t: x": 0.5, "u: x": 0.25})

    def test_report(self):
        report = {"seconds": {"wall": 2.0, "compute": 1.5, "stages": {"census": 0.75}}}
        self.assertEqual(compare.figures_in_seconds(report),
                         {"wall": 2.0, "compute": 1.5, "census": 0.75})

    def test_other_json(self):
        for document in ({}, [], [{"name": "x"}], 3, {"benchmarks": []}, {"seconds": {}}):
            with self.assertRaises(compare.CompareError):
                compare.figures_in_seconds(document)


class Runs(unittest.TestCase):
    def test_order_and_what_belongs_to_whom(self):
        order = []

        def run(command):
            order.append(command[0])
            return {"time": float(len(order)), **({command[0]: 1.0})}

        figures, missing = compare.run_interleaved(["a"], ["b"], 3, run)
        self.assertEqual("".join(order), "ab" + "ab" + "ba" + "ab")
        self.assertEqual(figures, {"time": ([3, 6, 7], [4, 5, 8])})
        self.assertEqual(missing, ["a", "b"])


def program(*arguments):
    return subprocess.run([sys.executable, "-B", str(COMPARE), *arguments],
                          capture_output=True, text=True, check=False)


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.script = Path(self.folder.name) / "measure.py"
        self.script.write_text(
            "import json, sys\n"
            "json.dump({'rows': [{'name': 'x', 'median_seconds': float(sys.argv[1])}]},"
            " open(sys.argv[2], 'w'))\n", encoding="utf-8")

    def command(self, seconds):
        return f"'{sys.executable}' '{self.script}' {seconds}"

    def test_two_commands_with_figures(self):
        results = Path(self.folder.name) / "results.json"
        done = program("--rounds", "5", "--json", str(results), self.command(4), self.command(1),
                       "--", "{json}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("B is faster", done.stdout)
        figure = json.loads(results.read_text(encoding="utf-8"))["figures"]["x"]
        self.assertEqual(figure["ratio"], {"median": 0.25, "least": 0.25, "most": 0.25})

    def test_wall_time(self):
        done = program("--rounds", "2", f"'{sys.executable}' -c pass", f"'{sys.executable}' -c pass")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("wall time of the command", done.stdout)

    def test_commands_that_fail(self):
        exits = f"'{sys.executable}' -c 'import sys; sys.exit(\"why\")'"
        for first, expected in [(exits, "exit code 1: why"), ("/nowhere/program", "No such file"),
                                (f"'{sys.executable}' -c pass {{json}}", "wrote no figures")]:
            with self.subTest(first=first):
                done = program("--rounds", "2", first, f"'{sys.executable}' -c pass")
                self.assertEqual(done.returncode, 1)
                self.assertEqual(done.stdout, "")
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(expected, done.stderr)

    def test_usage(self):
        for arguments in ([], ["a"], ["a", "b", "--rounds", "1"], ["a", "b", "--rounds", "x"], ["", "b"]):
            with self.subTest(arguments=arguments):
                done = program(*arguments)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(done.stdout, "")
        self.assertEqual(program("--help").returncode, 0)


if __name__ == "__main__":
    unittest.main()
