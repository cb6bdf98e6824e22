#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A batch on a real Slurm of two nodes on this machine: tests/cluster/run.py BURNISH [--if-there] [--seed S]
[--materials N] [--least TIMES] [--mpi BURNISH_MPI].

Starts munged, slurmctld and two slurmd of one processor each, with files, ports and a key of their own, in a folder
that goes afterwards; as root each node has process numbers of its own, so that a node can be killed with all that
runs on it and nobody sees its processes. Then the job array that `burnish batch --slurm` writes:

- on one node, and on both: the same bits as without Slurm, and how many times as fast, which has to be --least (on an
  idle machine with --materials 100: 1.8);
- on both, while processes are killed and a task is requeued at random moments: the same bits, nothing finished done
  twice;
- on both, while one node is killed: the job ends complete, with the same bits.

Where all came to an end before anything was killed it is tried again, a few times.

And with --mpi a job of `burnish-mpi fit-surface`, a rank on each node: the bytes of `burnish fit-surface`, also where
a rank is killed at a random moment and the job is started again. Without it burnish-mpi is looked for beside BURNISH's
folder, where -DBURNISH_MPI=ON builds it.

With --if-there it says so and succeeds where Slurm and munge (Debian: slurmctld, slurmd, slurm-client, munge) are
not installed. Exits with 1 where something else is found."""
import argparse
import getpass
import json
import os
import pathlib
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "mpi"))
from surface import OPTIONS, SCENE  # noqa: E402

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo"]
HOW = ["--model", "pqp", "--samples", "100000", "--threads", "1", "--patience", "2"]
PATIENCE = 60  # seconds of any wait
TRIES = 3  # of a kill that may come after the work's end
# mpirun starts a daemon on each node by srun. Both are this machine, and its ranks speak by TCP as on two.
MPI_SCRIPT = """\
#!/bin/bash
#SBATCH --nodes=2 --ntasks=2 --ntasks-per-node=1 --output={log}
export OMPI_MCA_btl=tcp,self
mpirun --allow-run-as-root --bind-to none -n 2 {fit}
"""
CONFIGURATION = """\
ClusterName=burnish
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdSpoolDir={folder}/spool-%n
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmdLogFile={folder}/slurmd-%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
JobCompType=jobcomp/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout=5
MinJobAge=300
KillWait=2
NodeName=node1 NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=1 State=UNKNOWN
NodeName=node2 NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def check(condition, message):
    if not condition:
        sys.exit(f"cluster: {message}")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def until(condition, what):
    start = time.monotonic()
    while not condition():
        check(time.monotonic() - start < PATIENCE, f"expected {what} within {PATIENCE} s, found none")
        time.sleep(0.1)


class Cluster:
    """Two nodes; `with` starts and ends it."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, {}
        port, first, second = free_ports(3)
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        (folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname(), port=port, first=first, second=second, folder=folder, user=getpass.getuser()))
        (folder / "state").mkdir()

    def __enter__(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        self.start("munged", "munged", "-F", "--force", "--key-file", str(key),
                   "--socket", f"{self.folder}/munge.socket",
                   "--pid-file", f"{self.folder}/munge.pid", "--seed-file", f"{self.folder}/munge.seed",
                   "--log-file", f"{self.folder}/munge.log")
        until((self.folder / "munge.socket").exists, "munged")
        self.start("slurmctld", "slurmctld", "-D")
        for node in ("node1", "node2"):
            self.start_node(node)
        until(lambda: self.states() == {"node1": "idle", "node2": "idle"}, "two idle nodes")
        return self

    def __exit__(self, *_):
        for name in ("node1", "node2", "slurmctld", "munged"):
            self.end(name)

    def start(self, name, *command):
        with open(self.folder / f"{name}.out", "a") as said:
            self.daemons[name] = subprocess.Popen(command, env=self.environment, stdout=said, stderr=said,
                                                  start_new_session=True)

    def start_node(self, node):
        apart = ["unshare", "--pid", "--fork", "--mount-proc", "--kill-child"] if os.geteuid() == 0 else []
        self.start(node, *apart, "slurmd", "-D", "-N", node)

    def end(self, name):
        """Ends a daemon; a node with all that runs on it."""
        if process := self.daemons.pop(name, None):
            process.kill()
            process.wait()
            if name.startswith("node") and os.geteuid() != 0:
                for pid in burnish_processes(self.folder, name):
                    os.kill(pid, signal.SIGKILL)

    def ask(self, *command):
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else ""

    def states(self):
        return dict(line.split() for line in self.ask("sinfo", "-h", "-N", "-o", "%N %T").splitlines())

    def submit(self, script):
        said = self.ask("sbatch", str(script))
        found = re.search(r"\d+", said)
        check(found, f"expected sbatch to take {script}, found '{said}'; see {self.folder}")
        return found.group()

    def waits_for(self, job):
        """Whether a task of the job is to run or running. A requeued one, which would rest for minutes, starts now."""
        tasks = [line.split() for line in self.ask("squeue", "-h", "-r", "-j", job, "-o", "%i %r").splitlines()]
        for task, reason in tasks:
            if reason == "BeginTime":
                self.ask("scontrol", "update", f"JobId={task}", "StartTime=now")
        return bool(tasks)


def burnish_processes(folder, node=None, verb=b"batch"):
    """Process numbers of the batches, or of another verb, that run below a folder; of a node where one is named."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
            if len(words) > 1 and words[1] == verb and str(folder).encode() in b" ".join(words):
                environment = (entry / "environ").read_bytes()
                if node is None or f"SLURMD_NODENAME={node}".encode() in environment.split(b"\0"):
                    found.append(int(entry.name))
        except (OSError, ValueError):
            continue
    return found


class Library:
    def __init__(self, burnish, scratch, count):
        self.burnish, self.list = burnish, scratch / "list"
        alphas = [0.1 + 0.3 * k / count for k in range(count)]
        self.list.write_text("\n".join(f"ggx:alpha_x={alpha:.4f},alpha_y={alpha:.4f}" for alpha in alphas))

    def batch(self, folder, *more):
        return subprocess.run([self.burnish, "batch", self.list, "-o", folder, *HOW, *more], check=True,
                              capture_output=True, text=True)

    def script(self, folder, tasks, *sbatch):
        self.batch(folder, "--slurm", "--tasks", str(tasks), *(f"--sbatch={option}" for option in sbatch))
        return folder / "batch.slurm"

    def check_complete(self, folder, models):
        found = {path.name: path.read_bytes() for path in (folder / "models").iterdir()}
        check(found == models, f"expected the bits of a batch without Slurm in {folder}, found {len(found)} models")
        check((folder / "library.sqlite").exists() and (folder / "index.html").exists(),
              "expected table and page of a complete batch")
        lines = [line for path in (folder / "journal").iterdir() for line in path.read_text().splitlines()]
        kinds = [re.match(r'{"event":"(\w*)"', line).group(1) for line in lines if line.endswith("}")]
        check(kinds.count("fitted") == len(models), f"expected {len(models)} fits, found {kinds.count('fitted')}")
        return kinds.count("began") - kinds.count("fitted")


def journal_times(folder, event):
    """When such events were, a list a process."""
    return [[float(found) for found in re.findall(rf'{{"event":"{event}".*"at":([\d.]+)}}', path.read_text())]
            for path in (folder / "journal").iterdir()]


def seconds_of(library, cluster, folder, tasks, models):
    """From when all tasks were at work to the last fit's end, by the journal, over the share of fits in that time."""
    job = cluster.submit(library.script(folder, tasks))
    until(lambda: not cluster.waits_for(job), "the job")
    library.check_complete(folder, models)
    begun = [min(times) for times in journal_times(folder, "began") if times]
    ends = sorted(time for times in journal_times(folder, "fitted") for time in times)
    start = max(begun)
    return (ends[-1] - start) * len(models) / sum(end > start for end in ends)


def killed(running, draw):
    """Ends one of these processes, if there is one, and says whether it did."""
    try:
        os.kill(draw.choice(running), signal.SIGKILL)
    except (IndexError, ProcessLookupError):  # none, or one that came to its end
        return False
    return True


def in_a_few_tries(disturb, folder, what):
    """disturb(folder), in a new folder each time, until something was killed while the work went on."""
    for number in range(TRIES):
        if disturb(folder.with_name(f"{folder.name}-{number + 1}")):
            return
    check(False, f"expected {what} killed while the work goes on, found the work's end {TRIES} times")


def kill_some(library, cluster, folder, models, draw):
    job = cluster.submit(library.script(folder, 2))
    until(lambda: (folder / "models").exists(), "the first task")
    kills = requeues = 0
    while cluster.waits_for(job) and kills + requeues < 4:
        time.sleep(draw.uniform(0.2, 0.8))
        running = burnish_processes(folder)
        if kills <= requeues:
            kills += killed(running, draw)
        elif running:
            cluster.ask("scontrol", "requeue", f"{job}_{draw.choice([1, 2])}")
            requeues += 1
    until(lambda: not cluster.waits_for(job), "the job whose tasks were killed")
    if len(list((folder / "models").iterdir())) < len(models):  # all were killed: the job is started again
        job = cluster.submit(folder / "batch.slurm")
        until(lambda: not cluster.waits_for(job), "the job that was started again")
    cut = library.check_complete(folder, models)
    print(f"{kills} processes killed, {requeues} tasks requeued, {cut} fits cut short: "
          "the same bits, nothing done twice")
    return kills > 0


def kill_node(library, cluster, folder, models, draw):
    job = cluster.submit(library.script(folder, 2))
    until(lambda: len(burnish_processes(folder)) == 2 or not cluster.waits_for(job), "both nodes at work")
    time.sleep(draw.uniform(0.2, 1.0))
    if not burnish_processes(folder, "node2"):
        until(lambda: not cluster.waits_for(job), "the job")
        return False
    cluster.end("node2")
    until(lambda: len(list((folder / "models").glob("*"))) == len(models) and not burnish_processes(folder),
          "the node that is left")
    cut = library.check_complete(folder, models)
    cluster.ask("scancel", job)
    print(f"a node killed in the middle, {cut} fits cut short: complete, the same bits, nothing done twice")
    return True


def fit_by_ranks(burnish, burnish_mpi, cluster, scratch, draw):
    scene, capture, alone, out = (scratch / name for name in ("scene.json", "capture", "alone.burnish", "out.burnish"))
    scene.write_text(json.dumps(SCENE | {"width": 128, "height": 128}))
    subprocess.run([burnish, "measure", "--surface", scene, "-o", capture], check=True, capture_output=True)
    start = time.monotonic()
    subprocess.run([burnish, "fit-surface", capture, "-o", alone, *OPTIONS], check=True, capture_output=True)
    seconds = time.monotonic() - start
    fit = [burnish_mpi, "fit-surface", capture, "-o", out, *OPTIONS, "--resume", "--memory", "1M"]
    script, log = scratch / "ranks.slurm", scratch / "ranks.log"
    script.write_text(MPI_SCRIPT.format(log=log, fit=" ".join(map(str, fit))))

    def ranks(node=None):
        return burnish_processes(scratch, node, b"fit-surface")

    def run_job(longest_wait=None):
        """Submits the job, kills a rank after at most so many seconds if asked; whether the job ended by it."""
        job = cluster.submit(script)
        until(lambda: ranks("node1") and ranks("node2") or not cluster.waits_for(job), "a rank on each node")
        by_kill = False
        if longest_wait is not None:
            time.sleep(draw.uniform(0, longest_wait))
            by_kill = killed(ranks(), draw)
        until(lambda: not cluster.waits_for(job), "the surface's job")
        return by_kill and not out.exists()

    def check_surface(how):
        check(out.exists() and out.read_bytes() == alone.read_bytes(),
              f"expected the bytes of burnish fit-surface, found {'others' if out.exists() else 'none'}; it said: "
              f"{log.read_text()[-800:]}")
        out.unlink()
        print(f"a surface by a rank on each node, {how}: the bytes of burnish fit-surface")

    run_job()
    check_surface("undisturbed")
    for number in range(TRIES):  # earlier each time
        if run_job(seconds / 2 / (number + 1)):
            break
        out.unlink(missing_ok=True)
    else:
        check(False, f"expected a rank killed while it fits, found the fit's end {TRIES} times")
    run_job()
    check_surface("1 killed and the job started again")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("--if-there", action="store_true")
    parser.add_argument("--seed", type=int, default=None, help="of the moments; by default another each time")
    parser.add_argument("--materials", type=int, default=24, help="to fit")
    parser.add_argument("--least", type=float, default=0, metavar="TIMES",
                        help="fail where two nodes are not so many times as fast as one")
    parser.add_argument("--mpi", help="burnish-mpi")
    arguments = parser.parse_args()
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    if missing := [program for program in PROGRAMS if not shutil.which(program)]:
        print(f"cluster: SKIPPED: no {', '.join(missing)} here")
        sys.exit(0 if arguments.if_there else 1)
    seed = arguments.seed if arguments.seed is not None else random.randrange(1 << 32)
    print(f"seed {seed}")
    draw = random.Random(seed)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("cluster: expected time to end, found a signal"))
    with tempfile.TemporaryDirectory(prefix="burnish-cluster-") as name:
        scratch = pathlib.Path(name)
        scratch.chmod(0o755)
        library = Library(os.path.abspath(arguments.burnish), scratch, arguments.materials)
        library.batch(scratch / "alone")
        models = {path.name: path.read_bytes() for path in (scratch / "alone/models").iterdir()}
        (scratch / "slurm").mkdir()
        with Cluster(scratch / "slurm") as cluster:
            one = seconds_of(library, cluster, scratch / "one", 1, models)
            both = seconds_of(library, cluster, scratch / "both", 2, models)
            print(f"one node {one:.1f} s, two nodes {both:.1f} s, {one / both:.2f} times as fast: the same bits")
            check(one / both >= arguments.least,
                  f"expected two nodes {arguments.least} times as fast as one, found {one / both:.2f}")
            in_a_few_tries(lambda folder: kill_some(library, cluster, folder, models, draw), scratch / "killed",
                           "a process")
            burnish_mpi = arguments.mpi or pathlib.Path(library.burnish).parent.parent / "mpi/burnish-mpi"
            if not os.path.exists(burnish_mpi) or not shutil.which("mpirun"):
                print("no burnish-mpi (-DBURNISH_MPI=ON) or no mpirun: no surface by ranks")
            else:
                (scratch / "surface").mkdir()
                fit_by_ranks(library.burnish, os.path.abspath(burnish_mpi), cluster, scratch / "surface", draw)
            in_a_few_tries(lambda folder: kill_node(library, cluster, folder, models, draw), scratch / "node",
                           "a node")


if __name__ == "__main__":
    main()
