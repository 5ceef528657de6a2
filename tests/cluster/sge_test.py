"""A batch on a grid engine ends with the bytes of one process, whatever happens to its tasks.

usage: sge_test.py VANTAGE

Exits with 77 where this machine cannot have a cell.
"""

import os
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import sge_cell
from sge_cell import SgeCell
from slurm_cluster import EXIT_SKIPPED, kill, processes_with, wait_until
from slurm_test import command_line, must_succeed, results

FRAMES = 24
TASKS = 3
JOB_SECONDS = 200  # of a machine that is busy with other tests
MATCHING = ["--method", "bayes", "--disparities", "0:31", "--iterations", "20", "--chunk-frames", "2"]


class SgeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.cell = cls.enterClassContext(SgeCell())
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.vantage("generate", "scene", "-o", cls.folder / "scene", "--frames", FRAMES, "--width", 240,
                    "--height", 180, "--samples", 1)
        pairs = "".join(f"pairs/{i},scene/left/{i:06}.png,scene/right/{i:06}.png\n" for i in range(3))
        cls.manifest = cls.folder / "what's to do.csv"
        cls.manifest.write_text(f"output,left,right\nfilm,scene/left,scene/right\n{pairs}", encoding="utf-8")
        cls.reference = cls.folder / "reference"
        cls.vantage("batch", cls.manifest, "-o", cls.reference, *MATCHING)

    @classmethod
    def vantage(cls, *arguments):
        return must_succeed(subprocess.run([VANTAGE, *map(str, arguments)], env=cls.cell.environment,
                                           capture_output=True, text=True, timeout=300, check=False))

    def log(self, task):
        file = self.out / ".vantage" / "submit" / f"task-{task}.log"
        return file.read_text(encoding="utf-8") if file.exists() else ""

    def logs(self):
        return "".join(f"-- {task}\n{self.log(task)}" for task in range(1, TASKS + 1))

    def workers(self, task):
        """The batch processes of a task, once one has begun to work."""
        if not (self.out / ".vantage" / "batch" / "leases").exists():
            return []
        of_task = (set(processes_with(f"SGE_TASK_ID={task}")) & set(processes_with(self.cell.marker)))
        return [process for process in of_task if command_line(process)[1:2] == ["batch"]]

    def test_a_killed_task_and_the_time_limit(self):
        self.out = self.folder / "out of 100% $HOME"
        self.vantage("submit", "--engine", "sge", self.manifest, "-o", self.out, *MATCHING, "--go",
                     "--tasks", TASKS, "--job-time", "1s", "--cpus", 1, "--task-memory", "400M",
                     "--time", "1", "--drain-time", 50, "--lease", "3s")
        killed = []

        # Frozen, it has its time limit before it, however fast this machine is.
        def freeze_first():
            for process in self.workers(1):
                os.kill(process, signal.SIGSTOP)
            return self.workers(1)

        def thaw_first():
            if "the time limit is near" not in self.log(1):
                return False
            for process in self.workers(1):
                os.kill(process, signal.SIGCONT)
            return True

        def kill_second():
            killed.extend(self.workers(2))
            kill(killed)
            return killed

        waiting = [freeze_first, thaw_first, kill_second]

        def at_end():
            waiting[:] = [action for action in waiting if not action()]
            return not self.cell.states()
        try:
            wait_until(at_end, JOB_SECONDS, "the end of all tasks")
        except sge_cell.ClusterError as error:
            self.fail(f"{error}\n{self.cell.sge('qstat', '-j', '*', check=False)}\n{self.logs()}")
        self.assertEqual(waiting, [], self.logs())
        self.assertIn("the time limit is near", self.log(1))
        self.assertIn("failed with exit code 137, is tried again", self.log(2))
        for task in range(1, TASKS + 1):
            self.assertTrue(self.log(task).endswith("done\n"), self.logs())
        expected, made = results(self.reference), results(self.out)
        self.assertGreater(len(expected), FRAMES)
        for content in (expected, made):
            content.pop("items.jsonl")  # it has times
        self.assertEqual(sorted(made), sorted(expected), self.logs())
        for name, content in expected.items():
            self.assertTrue(made[name] == content, f"{name} differs\n{self.logs()}")


if __name__ == "__main__":
    VANTAGE = sys.argv[1]
    if reason := sge_cell.why_impossible():
        print(f"skipped: {reason}")
        sys.exit(EXIT_SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
