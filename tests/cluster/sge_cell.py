"""A cell of Grid Engine with one host on this machine, for tests: real sge_qmaster and sge_execd.

Everything lies in a temporary folder; an installed cell is neither used nor changed. Needs root and
the packages gridengine-master, gridengine-exec and gridengine-client.
"""

import os
import shutil
import socket
import subprocess
import tempfile
from pathlib import Path

from slurm_cluster import ClusterError, free_ports, kill_all, start_guardian, wait_until

ROOT = Path("/var/lib/gridengine")
PROGRAMS = Path("/usr/lib/gridengine")
RESOURCES = Path("/usr/share/gridengine")
SLOTS = 2
NOTIFY_SECONDS = 10
START_SECONDS = 30

BOOTSTRAP = """\
admin_user none
default_domain none
ignore_fqdn true
spooling_method berkeleydb
spooling_lib libspoolb
spooling_params {folder}/spool/db
binary_path {programs}
qmaster_spool_dir {folder}/spool/qmaster
security_mode none
listener_threads 2
worker_threads 2
scheduler_threads 1
"""
HOST = """\
hostname {host}
load_scaling NONE
complex_values NONE
user_lists NONE
xuser_lists NONE
projects NONE
xprojects NONE
usage_scaling NONE
report_variables NONE
"""
ENVIRONMENT = """\
pe_name smp
slots 999
user_lists NONE
xuser_lists NONE
start_proc_args NONE
stop_proc_args NONE
allocation_rule $pe_slots
control_slaves FALSE
job_is_first_task TRUE
urgency_slots min
accounting_summary FALSE
qsort_args NONE
"""
QUEUE = {
    "qname": "main.q", "seq_no": "0", "load_thresholds": "NONE", "nsuspend": "1",
    "suspend_interval": "00:05:00", "priority": "0", "min_cpu_interval": "00:05:00",
    "processors": "UNDEFINED", "qtype": "BATCH", "pe_list": "smp", "rerun": "FALSE",
    "slots": str(SLOTS), "tmpdir": "/tmp", "shell": "/bin/sh", "shell_start_mode": "unix_behavior",
    "notify": f"00:00:{NOTIFY_SECONDS}", "initial_state": "default",
    **dict.fromkeys(("suspend_thresholds", "ckpt_list", "prolog", "epilog", "starter_method",
                     "suspend_method", "resume_method", "terminate_method", "owner_list",
                     "user_lists", "xuser_lists", "subordinate_list", "complex_values", "projects",
                     "xprojects", "calendar"), "NONE"),
    **{f"{kind}_{limit}": "INFINITY" for kind in "sh"
       for limit in ("rt", "cpu", "fsize", "data", "stack", "core", "rss", "vmem")}}


def why_impossible():
    """Why this machine cannot have a cell; None when it can."""
    if os.geteuid() != 0:
        return "a cell of Grid Engine for tests needs root"
    missing = [package for program, package in (("sge_qmaster", "gridengine-master"),
                                                ("sge_execd", "gridengine-exec"),
                                                ("qsub", "gridengine-client"))
               if not (PROGRAMS / program).exists()]
    return f"packages that are not installed: {', '.join(missing)}" if missing else None


class SgeCell:
    """One host with two slots for as long as the `with` block lasts."""

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="vantage-sge-"))
        self.folder.chmod(0o755)
        self.host = socket.gethostname().split(".")[0]
        self.marker = f"SGE_ROOT={self.folder}/root"
        master_port, execution_port = free_ports(2)
        self.environment = {
            **os.environ, "PATH": f"{PROGRAMS}:{os.environ.get('PATH', '')}",
            "SGE_ROOT": f"{self.folder}/root", "SGE_CELL": "test", "SGE_ND": "1",
            "SGE_QMASTER_PORT": str(master_port), "SGE_EXECD_PORT": str(execution_port)}
        self.guard = start_guardian(self.folder, self.marker)
        self.daemons = []

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self):
        self.configure()
        self.start_daemon("sge_qmaster")
        wait_until(lambda: self.sge("qconf", "-sh", check=False), START_SECONDS, "sge_qmaster")
        self.add("-Ae", HOST.format(host=self.host))
        self.add("-Ap", ENVIRONMENT)
        self.sge("qconf", "-as", self.host)
        queue = {**QUEUE, "hostlist": self.host}
        self.add("-Aq", "".join(f"{key} {value}\n" for key, value in queue.items()))
        schedule = self.sge("qconf", "-ssconf").replace("flush_submit_sec                 0",
                                                        "flush_submit_sec 1")
        schedule = schedule.replace("flush_finish_sec                 0", "flush_finish_sec 1")
        self.add("-Msconf", schedule.replace("schedule_interval                 0:0:15",
                                             "schedule_interval 0:0:1"))
        self.start_daemon("sge_execd")
        wait_until(lambda: "lx-" in self.sge("qhost", "-h", self.host, check=False), START_SECONDS,
                   "sge_execd")

    def configure(self):
        root = self.folder / "root"
        common = root / "test" / "common"
        for folder in (common, *(self.folder / "spool" / name
                                 for name in ("db", "qmaster/job_scripts", "execd"))):
            folder.mkdir(parents=True)
        for name in ("bin", "util", "utilbin", "lib"):
            (root / name).symlink_to(ROOT / name)
        # The name of this machine may be that of the loopback interface, which SGE refuses.
        (common / "host_aliases").write_text(f"{self.host} localhost\n", encoding="utf-8")
        (common / "act_qmaster").write_text(f"{self.host}\n", encoding="utf-8")
        (common / "bootstrap").write_text(
            BOOTSTRAP.format(folder=self.folder, programs=PROGRAMS), encoding="utf-8")
        lines = (RESOURCES / "default-configuration").read_text(encoding="utf-8").splitlines()
        changed = {"min_uid": "0", "min_gid": "0", "load_report_time": "00:00:01",
                   "execd_spool_dir": f"{self.folder}/spool/execd"}
        configuration = self.folder / "configuration"
        configuration.write_text(
            "".join(f"{key} {changed.get(key, value)}\n"
                    for key, _, value in (line.partition(" ") for line in lines)),
            encoding="utf-8")
        resources = RESOURCES / "util/resources"
        self.sge("spoolinit", "berkeleydb", "libspoolb", f"{self.folder}/spool/db", "init")
        for what, source in (("configuration", configuration), ("complexes", resources / "centry"),
                             ("usersets", resources / "usersets"), ("managers", "root")):
            self.sge("spooldefaults", what, source)

    def add(self, option, text):
        file = self.folder / "object"
        file.write_text(text, encoding="utf-8")
        self.sge("qconf", option, file)

    def start_daemon(self, name):
        with open(self.folder / f"{name}.out", "ab") as out:
            self.daemons.append(subprocess.Popen([PROGRAMS / name], stdin=subprocess.DEVNULL,
                                                 stdout=out, stderr=out, env=self.environment))

    def sge(self, program, *arguments, check=True):
        """What a program of Grid Engine prints."""
        done = subprocess.run([PROGRAMS / program, *arguments], env=self.environment,
                              capture_output=True, text=True, timeout=60, check=False)
        if check and done.returncode != 0:
            raise ClusterError(f"{program} {' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
        return done.stdout if done.returncode == 0 else ""

    def states(self):
        """Task → state of all that is in the queue; a task that waits may share its line."""
        lines = self.sge("qstat", "-g", "d").splitlines()[2:]
        return {line.split()[-1]: line.split()[4] for line in lines}

    def stop(self):
        kill_all(self.marker)
        for daemon in self.daemons:
            daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
        os.close(self.guard)
