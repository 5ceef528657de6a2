"""What `vantage submit` writes for the engines that run the items of a manifest.

usage: engines_test.py VANTAGE

Texts are read by other programs than ours: YAML by PyYAML, scripts by bash, the calls of AWS Batch
by the model of botocore, where these are installed.
"""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

TASKS = ["--tasks", "40", "--cpus", "4", "--task-memory", "8G"]
ONE_TASK = ["--tasks", "1", *TASKS[2:]]
CONTAINER_COMMAND = ["vantage", "batch", "s3://films/odd $(HOME) é.csv", "--output", "s3://films/results",
                     "--save=disparity", "--save=views", "--memory=6553M", "--threads=4", "--grace=90s",
                     "--index=auto"]


def module(name):
    """A module that may not be installed."""
    return importlib.import_module(name) if importlib.util.find_spec(name) else None


class EnginesTest(unittest.TestCase):

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.calls = self.folder / "calls"
        self.manifest = self.folder / "films.csv"
        self.manifest.write_text("output,left,right\none,left.png,right.png\n", encoding="utf-8")
        (self.folder / "programs").mkdir()
        self.environment = {**os.environ, "PATH": f"{self.folder}/programs:{os.environ['PATH']}"}

    def add_program(self, name, body=""):
        """A script that notes how it was called."""
        file = self.folder / "programs" / name
        file.write_text(f'#!/bin/bash\necho "{name} $*" >>"{self.calls}"\n{body}\n', encoding="utf-8")
        file.chmod(0o755)
        return file

    def noted_calls(self):
        return self.calls.read_text(encoding="utf-8").splitlines() if self.calls.exists() else []

    def run_submit(self, *arguments):
        return subprocess.run([VANTAGE, "submit", *map(str, arguments)], cwd=self.folder, text=True,
                              env=self.environment, capture_output=True, timeout=60, check=False)

    def submit(self, engine, *arguments):
        result = self.run_submit("--engine", engine, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def submit_container(self, engine, *arguments, tasks=TASKS):
        """Of a manifest and results that are not on this machine."""
        return self.submit(engine, CONTAINER_COMMAND[2], "-o", "s3://films/results", *tasks, "--save",
                           "disparity,views", "--image", 'films/"vantage":1', *arguments)

    def test_kubernetes_gets_an_indexed_job(self):
        result = self.submit_container(
            "kubernetes", "--concurrent", "10", "--retries", "5", "--time", "2:00:00", "--service-account",
            "films", "--volume-claim", "films:/data", "--volume-claim", "cache:/cache")
        file = self.folder / "vantage-results" / "job.yaml"
        self.assertIn(f"kubectl create -f {file}\n", result.stdout)
        yaml = module("yaml")
        if yaml is None:
            self.skipTest("no PyYAML")
        job = yaml.safe_load(file.read_text(encoding="utf-8"))
        self.assertEqual(job.pop("apiVersion"), "batch/v1")
        self.assertEqual(job.pop("kind"), "Job")
        self.assertEqual(job.pop("metadata"), {"name": "vantage-results"})
        pod = job["spec"].pop("template")["spec"]
        of_code = {"containerName": "vantage", "operator": "In"}
        self.assertEqual(job, {"spec": {
            "completionMode": "Indexed", "completions": 40, "parallelism": 10,
            "backoffLimitPerIndex": 5, "maxFailedIndexes": 40,
            "podFailurePolicy": {"rules": [
                {"action": "Ignore", "onPodConditions": [{"type": "DisruptionTarget", "status": "True"}]},
                {"action": "FailJob", "onExitCodes": {**of_code, "values": [2]}},
                {"action": "FailIndex", "onExitCodes": {**of_code, "values": [3]}}]}}})
        container, = pod.pop("containers")
        self.assertEqual(pod, {
            "restartPolicy": "Never", "terminationGracePeriodSeconds": 120, "activeDeadlineSeconds": 7200,
            "serviceAccountName": "films",
            "volumes": [{"name": f"claim-{i}", "persistentVolumeClaim": {"claimName": name}}
                        for i, name in ((1, "films"), (2, "cache"))]})
        self.assertEqual(container, {
            "name": "vantage", "image": 'films/"vantage":1',
            # Kubernetes replaces $(NAME), and makes $$( a $( again.
            "command": [word.replace("$(", "$$(") for word in CONTAINER_COMMAND],
            "env": [{"name": "VANTAGE_BATCH_TASKS", "value": "40"}],
            "resources": {"requests": {"cpu": 4, "memory": "8192Mi"}, "limits": {"memory": "8192Mi"}},
            "volumeMounts": [{"name": "claim-1", "mountPath": "/data"},
                             {"name": "claim-2", "mountPath": "/cache"}]})

    def aws_calls(self):
        folder = self.folder / "vantage-results"
        return [json.loads((folder / name).read_text(encoding="utf-8"))
                for name in ("job-definition.json", "submit-job.json")]

    def test_aws_batch_gets_a_definition_and_an_array_job(self):
        self.submit_container("aws-batch", "--queue", "spot", "--retries", "9", "--time", "60",
                              "--job-role", "arn:aws:iam::123456789012:role/films",
                              "--execution-role", "arn:aws:iam::123456789012:role/images")
        definition, call = self.aws_calls()
        self.assertEqual(definition, {
            "jobDefinitionName": "vantage-results", "type": "container",
            "containerProperties": {
                "image": 'films/"vantage":1',
                "command": [word.replace("90s", "22s") for word in CONTAINER_COMMAND],
                "resourceRequirements": [{"type": "VCPU", "value": "4"}, {"type": "MEMORY", "value": "8192"}],
                "environment": [{"name": "VANTAGE_BATCH_TASKS", "value": "40"}],
                "jobRoleArn": "arn:aws:iam::123456789012:role/films",
                "executionRoleArn": "arn:aws:iam::123456789012:role/images"},
            "retryStrategy": {"attempts": 10, "evaluateOnExit": [
                {"onStatusReason": "Host EC2*", "action": "RETRY"},
                {"onExitCode": "2", "action": "EXIT"}, {"onExitCode": "3", "action": "EXIT"}]},
            "timeout": {"attemptDurationSeconds": 3600}})
        self.assertEqual(call, {"jobName": "vantage-results", "jobQueue": "spot",
                                "jobDefinition": "vantage-results", "arrayProperties": {"size": 40}})
        if module("botocore"):
            from botocore import loaders, model, validate
            service = model.ServiceModel(loaders.Loader().load_service_model("batch", "service-2"))
            for name, values in (("RegisterJobDefinition", definition), ("SubmitJob", call)):
                problems = validate.ParamValidator().validate(
                    values, service.operation_model(name).input_shape)
                self.assertFalse(problems.has_errors(), problems.generate_report())

    def test_a_single_task_is_no_array(self):
        self.submit_container("aws-batch", "--queue", "spot", tasks=ONE_TASK)
        definition, call = self.aws_calls()
        self.assertNotIn("arrayProperties", call)
        self.assertIn("--index=1/1", definition["containerProperties"]["command"])

    def test_nothing_is_submitted_without_go(self):
        for program in ("kubectl", "aws", "qsub", "sbatch"):
            self.add_program(program)
        out = self.folder / "out"
        commands = {}
        for engine, options in (("kubernetes", ["--image", "vantage"]), ("slurm", []), ("sge", []),
                                ("aws-batch", ["--image", "vantage", "--queue", "spot"])):
            arguments = [self.manifest, "-o", out, *TASKS, *options]
            said = self.submit(engine, *arguments).stdout
            commands[engine] = [line.strip() for line in said.splitlines() if line.startswith("  ")]
            self.assertEqual(self.noted_calls(), [])
            self.submit(engine, *arguments, "--go")
            self.assertEqual(self.noted_calls(), commands[engine])
            self.calls.unlink()
        self.assertEqual(len(commands["aws-batch"]), 2)
        self.add_program("qsub", "echo 'Unable to run job: no queue' >&2; exit 1")
        refused = self.run_submit("--engine", "sge", self.manifest, "-o", out, *TASKS, "--go")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("refused by qsub: Unable to run job: no queue\n", refused.stderr)

    def script(self, engine, *arguments):
        """The script for `engine`, whose tasks start a stand-in for vantage."""
        out = self.folder / f"what's out of {engine}"
        self.submit(engine, self.manifest, "-o", out, *TASKS, "--program",
                    self.folder / "programs" / "vantage", *arguments)
        return out / ".vantage" / "submit" / "array.sh"

    def directives(self, script, prefix):
        return [line.removeprefix(prefix).strip() for line in script.read_text(encoding="utf-8").splitlines()
                if line.startswith(prefix)]

    def test_directives_of_scripts(self):
        script = self.script("sge", "--time", "2:00:00", "--concurrent", "8", "--queue", "all.q",
                             "--qsub-option", "-l arch=lx-amd64", "--retries", "1")
        self.assertEqual(self.directives(script, "#$"), [
            "-S /bin/bash", "-N vantage-what-s-out-of-sge", "-t 1-40", "-r y", "-notify", "-j y",
            "-o /dev/null",
            "-tc 8", "-pe smp 4", "-l mem_free=2048M", "-l h_rt=7200", "-q all.q",
            "-l arch=lx-amd64"])
        script = self.script("slurm", "--time", "2:00:00")
        self.assertEqual(self.directives(script, "#SBATCH"), [
            "--job-name=vantage-what-s-out-of-slurm", "--array=1-40",
            f'--output="{script.parent}/task-%a.log"',
            "--signal=B:USR1@120", "--cpus-per-task=4", "--open-mode=append", "--requeue", "--ntasks=1",
            "--time=02:00:00", "--mem=8192M"])

    def test_requests_come_from_the_plan_of_the_batch(self):
        scene = self.folder / "scene"
        batch = ["batch", self.manifest, "-o", self.folder / "out", "--threads", "2", "--dry-run",
                 "--report", self.folder / "plan.json"]
        # Pairs with different options are different jobs.
        self.manifest.write_text("output,left,right,preset\n" + "".join(
            f"{preset},{scene}/left.png,{scene}/right.png,{preset}\n"
            for preset in ("realtime", "balanced", "quality")), encoding="utf-8")
        for words in (["generate", "scene", "-o", scene, "--width", "96", "--height", "64"], batch):
            subprocess.run([VANTAGE, *map(str, words), "--quiet"], check=True, timeout=60,
                           capture_output=True)
        jobs = json.loads((self.folder / "plan.json").read_text(encoding="utf-8"))["results"]["jobs"]
        largest = max(job["memory_bytes"] for job in jobs)
        memory = -(-(int(largest * 1.25) + (256 << 20)) // 2 // (1 << 20))
        said = self.submit("sge", self.manifest, "-o", self.folder / "out", "--cpus", "2").stdout
        self.assertIn("3 items, 3 frames: 3 jobs", said)
        script = self.folder / "out" / ".vantage" / "submit" / "array.sh"
        found = self.directives(script, "#$")
        for expected in ("-t 1-3", "-pe smp 2", f"-l mem_free={memory}M", "-l h_rt=3600"):
            self.assertIn(expected, found)
        self.submit("sge", self.manifest, "-o", self.folder / "out", "--tasks", "2", "--time", "30")
        found = self.directives(script, "#$")
        for expected in ("-t 1-2", "-pe smp 4", "-l h_rt=1800"):
            self.assertIn(expected, found)
        for cpus in ("1", "2"):  # goes on with other means
            self.submit("local", self.manifest, "-o", self.folder / "out", "--cpus", cpus,
                        "--concurrent", "1", "--go", "--quiet")

    def run_task(self, script, environment, meanwhile=""):
        """Exit code and log of task 2; `meanwhile` is bash that knows the task's process."""
        line = f'bash "$0" >>"$(dirname "$0")/task-2.log" 2>&1 & task=$!\n{meanwhile}\nwait $task'
        done = subprocess.run(["bash", "-c", line, script], env={**self.environment, **environment},
                              timeout=60, check=False)
        return done.returncode, (script.parent / "task-2.log").read_text(encoding="utf-8")

    def test_exit_codes_say_what_becomes_of_a_task(self):
        self.add_program("scontrol")
        slurm = {"SLURM_ARRAY_JOB_ID": "41", "SLURM_ARRAY_TASK_ID": "2"}
        sge = {"JOB_ID": "41", "SGE_TASK_ID": "2"}
        for engine, environment, again in (("slurm", slurm, 0), ("sge", sge, 99)):
            script = self.script(engine, "--retries", "1")
            for code, expected, says in ((0, 0, "done"), (3, 3, "some of it was skipped"), (2, 2, "refused"),
                                         (75, again, "is tried again"), (1, 1, "given up after 2 attempts")):
                self.add_program("vantage", f"exit {code}")
                found, log = self.run_task(script, environment)
                self.assertEqual(found, expected, log)
                self.assertIn(says, log)
        called = self.noted_calls()
        self.assertEqual([call for call in called if call.startswith("scontrol")], ["scontrol requeue 41_2"])
        self.assertIn(f"vantage batch {self.manifest} --output {self.folder}/what's out of sge "
                      "--memory=6553M --threads=4 --grace=90s --index=auto", called)

    def add_patient_vantage(self, first=""):
        """One that says a job is done, makes the returned file, and ends when it is told to."""
        ready = self.folder / "ready"
        # Not in bash: it cannot catch INT when it has been started with INT ignored.
        text = ("import os, signal, sys, time\n"
                "for s in signal.SIGINT, signal.SIGTERM: signal.signal(s, lambda *_: sys.exit(75))\n"
                f"{first}print('batch: job 000001', flush=True)\nopen('{ready}', 'w')\ntime.sleep(60)")
        self.add_program("vantage", f'exec "{sys.executable}" -c "{text}"')
        return ready

    def test_sge_tells_a_task_to_end_and_the_task_tells_its_command(self):
        ready = self.add_patient_vantage(
            "for s in signal.SIGUSR1, signal.SIGUSR2: os.kill(os.getpid(), s)\n")
        for signal, expected, says in (("USR1", 99, "goes on in a new job"), ("USR2", 75, "stopped by SGE")):
            code, log = self.run_task(
                self.script("sge"), {"JOB_ID": "41", "SGE_TASK_ID": "2"},
                f'until [ -e "{ready}" ]; do sleep 0.02; done; rm "{ready}"; kill -{signal} $task')
            self.assertIn(says, log)
            self.assertEqual(code, expected, log)

    def test_local_workers_run_side_by_side(self):
        self.add_program("vantage", 'echo "$*"; exit 3')
        arguments = ["--cpus", "1", "--task-memory", "10M", "--program", self.folder / "programs" / "vantage",
                     self.manifest, "-o", self.folder / "out", "--concurrent", "2"]
        said = self.submit("local", *arguments).stdout
        self.assertEqual(self.noted_calls(), [])
        workers = min(2, len(os.sched_getaffinity(0)))
        self.assertEqual(said.count(" --worker\n"), workers)
        done = self.run_submit("--engine", "local", *arguments, "--go")
        self.assertEqual(done.returncode, 3, done.stderr)
        logs = sorted((self.folder / "out/.vantage/submit").glob("worker-*.log"))
        self.assertEqual(len(logs), workers)
        for log in logs:
            self.assertEqual(log.read_text(encoding="utf-8"), f"batch {self.manifest} --output "
                             f"{self.folder}/out --memory=8M --threads=1 --grace=90s --worker\n")

    def test_local_workers_are_told_to_end(self):
        ready = self.add_patient_vantage()
        submission = subprocess.Popen(
            [VANTAGE, "submit", "--engine", "local", "--cpus", "1", "--task-memory", "10M",
             "--program", self.folder / "programs" / "vantage", self.manifest,
             "-o", self.folder / "out", "--concurrent", "1", "--go", "--quiet"],
            env=self.environment, stderr=subprocess.DEVNULL)
        while not ready.exists():
            time.sleep(0.02)
        submission.terminate()
        self.assertEqual(submission.wait(timeout=30), 75)

    def test_wrong_usage_is_one_line(self):
        out = self.folder / "out"
        for arguments, says in (
                (["--engine", "kubernetes", self.manifest, *TASKS], "--image is missing"),
                (["--engine", "kubernetes", "--image", "x"], "MANIFEST is missing"),
                (["--engine", "kubernetes", self.manifest, *TASKS, "--image", "x", "--volume-claim", "films"],
                 "--volume-claim is 'films', expected NAME:/PATH"),
                (["--engine", "aws-batch", self.manifest, *TASKS, "--image", "x"], "--queue is missing"),
                (["--engine", "aws-batch", self.manifest, *TASKS, "--image", "x", "--queue", "q",
                  "--retries", "10"], "--retries is 10, expected a number from 0 to 9"),
                (["--engine", "aws-batch", self.manifest, *TASKS, "--image", "x", "--queue", "q",
                  "--drain-time", "60"], "--drain-time has no effect with --engine aws-batch"),
                (["--engine", "sge", self.manifest, *TASKS, "--time", "1", "--drain-time", "60"],
                 "--drain-time is 60, expected a number from 1 to 59"),
                (["--engine", "sge", self.manifest, *TASKS, "--image", "x"],
                 "--image has no effect with --engine sge"),
                (["--engine", "sge", self.manifest, *TASKS, "--queue", "a b"], "--queue is 'a b'"),
                (["--engine", "slurm", self.manifest, *TASKS, "--shards", "3"], "--shards has no effect"),
                (["--left", "left", "--right", "right", "--shards", "3", "--tasks", "4"],
                 "--tasks has no effect without a manifest"),
                (["--no-submit", self.manifest], "without --go scripts are only written"),
                (["--engine", "local", self.manifest, *TASKS], "--tasks has no effect with --engine local"),
                (["--engine", "sge", "films\n.csv", *TASKS], "control characters")):
            result = self.run_submit(*arguments, "-o", out)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertTrue(result.stderr.startswith("vantage submit: "), result.stderr)
            self.assertIn(says, result.stderr)
            self.assertFalse(out.exists())


if __name__ == "__main__":
    VANTAGE = sys.argv[1]
    unittest.main(argv=sys.argv[:1], verbosity=2)
