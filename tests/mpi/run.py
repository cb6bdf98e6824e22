#!/usr/bin/env python3
"""Fits a small surface with 1, 2 and 4 ranks: tests/mpi/run.py BURNISH BURNISH_MPI [--kills N] [--side N] [--time [CAPTURE]].

The file has to be that of `burnish fit-surface` to the byte, also where a rank is killed at a random moment and the
job is started again with --resume. --time prints the seconds of one rank and of two with a thread each, the least of
three: all of a fit, and weights alone (--book); of four lobes to another capture where it names one. Exits with 1 where
something differs."""
import argparse
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

from surface import OPTIONS, SCENE


def mpirun(ranks):
    return ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)]


def run(command, **more):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout}")


def ranks_of(launcher):
    """The processes that an mpirun started."""
    found = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(launcher.pid)], stdout=subprocess.PIPE, text=True)
    return [int(line.split()[0]) for line in found.stdout.splitlines() if "burnish" in line]


def killed_once(burnish_mpi, capture, out, moment):
    """Starts a job, kills one of its ranks after so many seconds, and says whether it was in time."""
    fit = [burnish_mpi, "fit-surface", capture, "-o", out, *OPTIONS, "--resume", "--memory", "1M"]
    job = subprocess.Popen(mpirun(2) + fit, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(moment)
    ranks = ranks_of(job)
    if ranks:
        os.kill(random.choice(ranks), signal.SIGKILL)
    return job.wait() != 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("burnish_mpi")
    parser.add_argument("--kills", type=int, default=2)
    parser.add_argument("--side", type=int, default=64)
    parser.add_argument("--time", nargs="?", const="", metavar="CAPTURE")
    given = parser.parse_args()
    random.seed(21)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        scene, capture, alone = folder / "scene.json", folder / "capture", folder / "alone.burnish"
        scene.write_text(json.dumps(SCENE | {"width": given.side, "height": given.side}))
        run([given.burnish, "measure", "--surface", scene, "-o", capture])
        start = time.monotonic()
        run([given.burnish, "fit-surface", capture, "-o", alone, *OPTIONS])
        seconds = time.monotonic() - start

        for ranks in (1, 2, 4):
            out = folder / f"{ranks}.burnish"
            run(mpirun(ranks) + [given.burnish_mpi, "fit-surface", capture, "-o", out, *OPTIONS])
            if out.read_bytes() != alone.read_bytes():
                sys.exit(f"{ranks} ranks: other bytes")
        print("1, 2 and 4 ranks: the same bytes")

        out, lost = folder / "killed.burnish", 0
        for _ in range(given.kills):
            lost += killed_once(given.burnish_mpi, capture, out, random.uniform(0.3, 1 + seconds))
        run(mpirun(2) + [given.burnish_mpi, "fit-surface", capture, "-o", out, *OPTIONS, "--resume"])
        if out.read_bytes() != alone.read_bytes():
            sys.exit("killed and started again: other bytes")
        print(f"a rank killed {given.kills} times, {lost} of them before the end: the same bytes")

        if given.time is not None:
            of_lobes = ["--lobes", "4", "--threads", "1"] if given.time else OPTIONS
            print_times([given.burnish_mpi, "fit-surface", given.time or capture], of_lobes, folder)


def print_times(fit, of_lobes, folder):
    made = folder / "timed.burnish"
    for what, more in ("all of it", [*of_lobes, "-o", made]), (
            "weights alone", ["--book", made, "--threads", "1", "-o", folder / "weights.burnish"]):
        took = {}
        for ranks in (1, 2, 1, 2, 1, 2):
            start = time.monotonic()
            run(mpirun(ranks) + fit + more)
            took[ranks] = min(took.get(ranks, 1e9), time.monotonic() - start)
        print(f"{what}: {took[1]:.2f} s with one rank, {took[2]:.2f} s with two: {took[1] / took[2]:.2f}")


if __name__ == "__main__":
    main()
