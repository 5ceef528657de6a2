#!/usr/bin/env python3
"""A Slurm cluster of two nodes on this machine, for tests: real munged, slurmctld and slurmd.

usage: slurm_cluster.py COMMAND [ARGUMENT...]

Starts the cluster, runs COMMAND with SLURM_CONF set, takes everything down again and exits as
COMMAND did, or with 1 when the cluster does not start and 77 when this machine cannot have one.
Everything lies in a temporary folder; Slurm installed on the machine is neither used nor changed.
Needs root and the packages slurmctld, slurmd, slurm-client and munge; neither systemd nor cgroups.
"""

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXIT_SKIPPED = 77
NODES = ("node1", "node2")
START_SECONDS = 30

PACKAGES = {"munged": "munge", "slurmctld": "slurmctld", "slurmd": "slurmd",
            "sbatch": "slurm-client", "scontrol": "slurm-client", "squeue": "slurm-client"}

# Short waits: a node counts as down after SlurmdTimeout, and a job that was put back into the queue
# may start again when its old credential has expired (cred_expire).
CONFIGURATION = """\
ClusterName=vantage-test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
SlurmctldPort={controller_port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/log/slurmctld.log
StateSaveLocation={folder}/state
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmdLogFile={folder}/log/slurmd-%n.log
SlurmdSpoolDir={folder}/spool-%n
SlurmdParameters=config_overrides
SlurmdTimeout=3
MessageTimeout=5
KillWait=5
ReturnToService=2
MpiDefault=none
SwitchType=switch/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,sched_min_interval=0
{nodes}
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
NODE = ("NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 "
        "RealMemory=1000 State=UNKNOWN")


class ClusterError(Exception):
    """The cluster does not start, or one of its commands fails."""


def why_impossible():
    """Why this machine cannot have a cluster; None when it can."""
    if os.geteuid() != 0:
        return "a Slurm cluster for tests needs root"
    missing = sorted({package for program, package in PACKAGES.items()
                      if shutil.which(program, path=search_path()) is None})
    return f"packages that are not installed: {', '.join(missing)}" if missing else None


def search_path():
    return os.environ.get("PATH", "") + ":/usr/sbin:/sbin"


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


def processes_with(entry):
    """Ids of the living processes that have `entry` ("NAME=value") in their environment."""
    found = []
    for process in Path("/proc").iterdir():
        if process.name.isdigit() and int(process.name) != os.getpid():
            with contextlib.suppress(OSError):
                if entry.encode() in (process / "environ").read_bytes().split(b"\0"):
                    found.append(int(process.name))
    return found


def parent_of(process):
    status = Path(f"/proc/{process}/status").read_text(encoding="utf-8", errors="replace")
    return int(next(line.split()[1] for line in status.splitlines() if line.startswith("PPid:")))


def kill(processes):
    for process in processes:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


def wait_until(condition, seconds, what):
    """Returns what `condition` returned as soon as that is true; ClusterError after `seconds`."""
    deadline = time.monotonic() + seconds
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > deadline:
            raise ClusterError(f"waited {seconds} s in vain for {what}")
        time.sleep(0.05)


class SlurmCluster:
    """Two idle nodes for as long as the `with` block lasts."""

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="vantage-slurm-"))
        self.folder.chmod(0o755)  # munged insists
        self.configuration = self.folder / "slurm.conf"
        self.marker = f"SLURM_CONF={self.configuration}"
        self.environment = {
            **{name: value for name, value in os.environ.items()
               if not name.startswith(("SLURM", "SBATCH", "SQUEUE"))},
            "PATH": search_path(), "SLURM_CONF": str(self.configuration)}
        self.guard = start_guardian(self.folder, self.marker)
        self.daemons = {}

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
        self.start_daemon("munged", [
            "munged", "--foreground", f"--key-file={self.folder}/munge.key",
            f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munged.pid",
            f"--log-file={self.folder}/log/munged.log", f"--seed-file={self.folder}/munge.seed"])
        self.wait_for((self.folder / "munge.socket").exists, "munged's socket")
        self.start_daemon("slurmctld", ["slurmctld", "-D"])
        for node in NODES:
            self.start_node(node)
        self.wait_for(lambda: all(state == "idle" for state in self.node_states().values()),
                      "both nodes to be idle")

    def configure(self):
        for name in ("log", "state"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        host = socket.gethostname().split(".")[0]
        controller_port, *node_ports = free_ports(1 + len(NODES))
        nodes = "\n".join(NODE.format(name=name, host=host, port=port)
                          for name, port in zip(NODES, node_ports))
        self.configuration.write_text(
            CONFIGURATION.format(host=host, folder=self.folder, nodes=nodes,
                                 controller_port=controller_port), encoding="utf-8")

    def start_daemon(self, name, command):
        with open(self.folder / "log" / f"{name}.out", "ab") as out:
            self.daemons[name] = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=out, stderr=out, env=self.environment)

    def start_node(self, node):
        self.start_daemon(node, ["slurmd", "-D", "-N", node])

    def kill_node(self, node):
        """The node's daemon and all that runs on it are gone at once, as when power fails."""
        daemon = self.daemons.pop(node)
        ours = set(processes_with(self.marker))
        jobs = ours & set(processes_with(f"SLURMD_NODENAME={node}"))
        keepers = ours & {parent_of(process) for process in jobs}
        kill({daemon.pid} | keepers | jobs)
        daemon.wait()

    def node_states(self):
        """Name → state ("idle", "allocated", "down*"); empty while the controller is silent."""
        answer = self.slurm("sinfo", "--noheader", "--Node", "--format=%N %T", check=False)
        return dict(line.split() for line in answer.splitlines()) or dict.fromkeys(NODES, "unknown")

    def slurm(self, *command, check=True):
        """What a Slurm command prints."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True,
                              timeout=60, check=False)
        if check and done.returncode != 0:
            raise ClusterError(f"{' '.join(command)}: {done.stderr.strip()}")
        return done.stdout if done.returncode == 0 else ""

    def wait_for(self, condition, what):
        def checked():
            for name, daemon in self.daemons.items():
                if daemon.poll() is not None:
                    raise ClusterError(f"{name} has ended with {daemon.returncode}")
            return condition()
        try:
            wait_until(checked, START_SECONDS, what)
        except ClusterError as error:
            raise ClusterError(f"{error}\n{self.logs()}") from None

    def logs(self, lines=15):
        """The ends of all daemons' logs."""
        text = ""
        for log in sorted((self.folder / "log").iterdir()):
            content = log.read_text(encoding="utf-8", errors="replace").splitlines()
            text += "".join(f"{log.name}: {line}\n" for line in content[-lines:])
        return text

    def stop(self):
        kill_all(self.marker)
        for daemon in self.daemons.values():
            daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
        os.close(self.guard)


def kill_all(marker):
    while processes := processes_with(marker):  # again: they may have forked meanwhile
        kill(processes)
        time.sleep(0.05)


def start_guardian(folder, marker):
    """A process of its own that takes the cluster down when this one dies without doing so.

    Returns the descriptor whose end it waits for.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child != 0:
        os.waitpid(child, 0)
        os.close(reader)
        return writer
    with contextlib.suppress(BaseException):
        os.setsid()
        if os.fork() == 0:  # no child of ours, so that nobody who ends our children ends it
            os.close(writer)
            nothing = os.open(os.devnull, os.O_RDWR)
            for stream in range(3):
                os.dup2(nothing, stream)
            os.read(reader, 1)
            kill_all(marker)
            shutil.rmtree(folder, ignore_errors=True)
    os._exit(0)


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if len(sys.argv) > 1 else 2
    if reason := why_impossible():
        print(f"skipped: {reason}", file=sys.stderr)
        return EXIT_SKIPPED
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    try:
        with SlurmCluster() as cluster:
            return subprocess.run(sys.argv[1:], env=cluster.environment, check=False).returncode
    except (ClusterError, OSError) as error:
        print(f"slurm_cluster: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
