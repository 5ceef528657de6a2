"""Runs on two Slurm nodes end with the bytes of a run on one machine, whatever happens to them.

usage: slurm_test.py VANTAGE FRAMES

Exits with 77 where this machine cannot have a cluster.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import slurm_cluster
from slurm_cluster import NODES, SlurmCluster, kill, processes_with, wait_until

CHUNK_FRAMES = 4
# One sample per pixel: making the scene would otherwise take longer than all that is shown with it.
SCENE = {"width": 240, "height": 180, "samples": 1}
MATCHING = ["--method", "bayes", "--disparities", "0:31", "--iterations", "20"]
TASKS = 3
JOB_SECONDS = 300  # of a machine that is busy with other tests


def vantage(*arguments, environment=None):
    return subprocess.run([VANTAGE, *map(str, arguments)], env=environment, capture_output=True,
                          text=True, timeout=300, check=False)


def must_succeed(result):
    if result.returncode != 0:
        raise AssertionError(f"{result.args} exits with {result.returncode}: {result.stderr}")
    return result


def results(folder):
    """Path → bytes of everything in a run's folder that is not hidden."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*"))
            if file.is_file() and ".vantage" not in file.relative_to(folder).parts}


def command_line(process):
    try:
        return Path(f"/proc/{process}/cmdline").read_text(encoding="utf-8").split("\0")
    except OSError:
        return []


class Run:
    """A run that has been submitted, as its folder and the cluster show it."""

    def __init__(self, cluster, folder):
        self.cluster = cluster
        self.folder = folder
        self.slurm_folder = folder / ".vantage" / "slurm"

    def jobs(self):
        return json.loads((self.slurm_folder / "submitted.json").read_text(encoding="utf-8"))

    def log(self, task):
        file = self.slurm_folder / f"task-{task}.log"
        return file.read_text(encoding="utf-8") if file.exists() else ""

    def logs(self):
        return "".join(f"-- {file.name}\n{file.read_text(encoding='utf-8')}"
                       for file in sorted(self.slurm_folder.glob("*.log")))

    def finished_frames(self, task):
        file = self.folder / ".vantage" / f"frames-{task}-of-{TASKS}.jsonl"
        return len(file.read_text(encoding="utf-8").splitlines()) if file.exists() else 0

    def processes(self, task):
        """The vantage processes of a task."""
        job = self.jobs()["array_job"]
        of_task = (set(processes_with(f"SLURM_ARRAY_TASK_ID={task}"))
                   & set(processes_with(f"SLURM_ARRAY_JOB_ID={job}"))
                   & set(processes_with(self.cluster.marker)))
        return [process for process in of_task if "--shard" in command_line(process)]

    def node(self, task):
        """Where a task runs; empty while it does not, or the controller is silent."""
        return self.cluster.slurm("squeue", "--noheader", "--format=%N", "--jobs",
                                  f"{self.jobs()['array_job']}_{task}", check=False).strip()

    def in_queue(self):
        """What Slurm has left to do; not empty while the controller is silent."""
        try:
            # Of all jobs: asked for those that are long done, it answers with an error.
            return self.cluster.slurm("squeue", "--noheader", "--array",
                                      "--format=%i %T %r").splitlines()
        except slurm_cluster.ClusterError as error:
            return [str(error)]

    def job(self, name):
        """The fields that Slurm keeps of a job."""
        fields = self.cluster.slurm("scontrol", "--oneliner", "show", "job", str(name)).split()
        return dict(field.split("=", 1) for field in fields if "=" in field)

    def wait_for_end(self, actions=()):
        """Until Slurm has nothing left to do; each action is done once, when it says it can."""
        waiting = list(actions)
        next_look = time.monotonic()

        def at_end():
            nonlocal next_look
            waiting[:] = [action for action in waiting if not action()]
            if time.monotonic() < next_look:
                return False
            next_look = time.monotonic() + 1
            return not self.in_queue()
        try:
            wait_until(at_end, JOB_SECONDS, f"the end of {self.jobs()}")
        except slurm_cluster.ClusterError as error:
            raise AssertionError(f"{error}\n{self.in_queue()}\n{self.logs()}") from None
        if waiting:
            names = [action.__name__ for action in waiting]
            raise AssertionError(f"did not come to {names}\n{self.logs()}")


class SlurmTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cluster = cls.enterClassContext(SlurmCluster())
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.scene = cls.folder / "scene"
        must_succeed(vantage("generate", "scene", "-o", cls.scene, "--frames", FRAMES,
                             *(f"--{name}={value}" for name, value in SCENE.items())))
        cls.reference = cls.folder / "reference"
        must_succeed(vantage("run", *cls.settings(), "-o", cls.reference))

    @classmethod
    def settings(cls):
        return ["--left", cls.scene / "left", "--right", cls.scene / "right", "--view", "0.5",
                "--save", "disparity,views", "--video", "views", "--chunk-frames", CHUNK_FRAMES,
                *MATCHING]

    def submit(self, folder, *more):
        return vantage("submit", "--engine", "slurm", *self.settings(), "-o", folder,
                       "--shards", TASKS, "--go", *more, environment=self.cluster.environment)

    def expect_reference(self, run):
        expected, made = results(self.reference), results(run.folder)
        self.assertEqual(sorted(made), sorted(expected), run.logs())
        self.assertGreater(len(expected), int(FRAMES))
        for name, content in expected.items():
            self.assertTrue(made[name] == content, f"{name} differs\n{run.logs()}")

    def test_a_dead_node_a_dead_process_and_the_time_limit(self):
        run = Run(self.cluster, self.folder / "what's 100% done")
        must_succeed(self.submit(run.folder, "--time", "1", "--drain-time", "40"))
        jobs = run.jobs()
        again = self.submit(run.folder)
        self.assertEqual(again.returncode, 1)
        self.assertIn("still in the queue", again.stderr)
        killed_nodes = []

        # Frozen, it has its time limit before it, however fast this machine is.
        def freeze_first():
            if run.finished_frames(1) == 0:
                return False
            for process in run.processes(1):
                os.kill(process, signal.SIGSTOP)
            return True

        def thaw_first():
            if "the time limit is near" not in run.log(1):
                return False
            for process in run.processes(1):
                os.kill(process, signal.SIGCONT)
            return True

        def kill_node_of_second():
            node = run.node(2) if run.finished_frames(2) > 0 else ""
            if not node:
                return False
            killed_nodes.append(node)
            self.cluster.kill_node(killed_nodes[0])
            return True

        def repair_node():
            states = self.cluster.node_states() if killed_nodes else {}
            if not any(states[node].startswith("down") for node in killed_nodes):
                return False
            self.cluster.start_node(killed_nodes[0])
            return True

        def kill_third():
            if run.finished_frames(3) == 0:
                return False
            kill(run.processes(3))
            return True

        run.wait_for_end([freeze_first, thaw_first, kill_node_of_second, repair_node, kill_third])
        self.expect_reference(run)
        self.assertIn(killed_nodes[0], NODES)
        self.assertIn("goes on in a new job", run.log(1))
        self.assertIn("failed with exit code 137, is tried again", run.log(3))
        for task in range(1, TASKS + 1):
            job = run.job(f"{jobs['array_job']}_{task}")
            self.assertEqual(job["JobState"], "COMPLETED", run.log(task))
            self.assertGreaterEqual(int(job["Restarts"]), 1, run.log(task))
        self.assertEqual(run.job(jobs["merge_job"])["JobState"], "COMPLETED")

    def test_a_task_that_cannot_succeed_is_given_up_and_continued_later(self):
        bad_frame = self.scene / "right" / f"{CHUNK_FRAMES + 1:06}.png"
        content = bad_frame.read_bytes()
        self.addCleanup(bad_frame.write_bytes, content)
        bad_frame.write_bytes(content[:len(content) // 2])
        run = Run(self.cluster, self.folder / "given-up")
        must_succeed(self.submit(run.folder, "--retries", "1"))
        run.wait_for_end()
        jobs = run.jobs()
        self.assertIn("given up after 2 attempts", run.logs())
        self.assertEqual(run.job(f"{jobs['array_job']}_1")["JobState"], "FAILED")
        self.assertEqual(run.job(f"{jobs['array_job']}_3")["JobState"], "COMPLETED")
        self.assertEqual(run.job(jobs["merge_job"])["JobState"], "CANCELLED")
        bad_frame.write_bytes(content)
        # Of the submission before, but for the input.
        again = ["submit", "--go", "--config", run.slurm_folder / "submit.toml"]
        result = vantage(*again, environment=self.cluster.environment)
        self.assertEqual(result.returncode, 1)
        self.assertIn("different run", result.stderr)
        must_succeed(vantage(*again, "--force", environment=self.cluster.environment))
        self.assertNotEqual(run.jobs(), jobs)
        run.wait_for_end()
        self.expect_reference(run)

    def test_the_items_of_a_manifest(self):
        manifest = self.folder / "films.csv"
        pairs = "".join(f"pair{i},scene/left/{i:06}.png,scene/right/{i:06}.png\n" for i in range(2))
        manifest.write_text(f"output,left,right\nfilm,scene/left,scene/right\n{pairs}", encoding="utf-8")
        options = [manifest, *MATCHING, "--chunk-frames", CHUNK_FRAMES]
        must_succeed(vantage("batch", *options, "-o", self.folder / "one process"))
        out = self.folder / "a task each"
        must_succeed(vantage("submit", "--engine", "slurm", "--go", *options, "-o", out, "--tasks", TASKS,
                             "--job-time", "1s", "--cpus", 1, "--task-memory", "400M", "--lease", "3s",
                             environment=self.cluster.environment))
        killed = []

        def workers():
            of_task = set(processes_with("SLURM_ARRAY_TASK_ID=2"))
            return [process for process in of_task & set(processes_with(self.cluster.marker))
                    if command_line(process)[1:2] == ["batch"]]

        def at_end():
            if not killed:
                killed.extend(workers())
                kill(killed)
            return not self.cluster.slurm("squeue", "--noheader", "--array")
        wait_until(at_end, JOB_SECONDS, "the end of all tasks")
        logs = {file.name: file.read_text(encoding="utf-8")
                for file in (out / ".vantage" / "submit").glob("task-*.log")}
        self.assertIn("failed with exit code 137, is tried again", logs["task-2.log"])
        self.assertEqual({text.splitlines()[-1].split(": ")[-1] for text in logs.values()}, {"done"}, logs)
        expected, made = results(self.folder / "one process"), results(out)
        for of_times in (expected, made):
            of_times.pop("items.jsonl")
        self.assertTrue(made == expected, logs)

    def test_what_slurm_refuses_is_one_line(self):
        result = self.submit(self.folder / "refused", "--partition", "nowhere")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn("nvalid partition", result.stderr)
        self.assertFalse((self.folder / "refused/.vantage/slurm/submitted.json").exists())


if __name__ == "__main__":
    VANTAGE, FRAMES = sys.argv[1:3]
    if reason := slurm_cluster.why_impossible():
        print(f"skipped: {reason}")
        sys.exit(slurm_cluster.EXIT_SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
