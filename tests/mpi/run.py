#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits a small surface with 1, 2 and 4 ranks: tests/mpi/run.py BURNISH BURNISH_MPI [--kills N] [--side N] [--time [CAPTURE]].

The file has to be that of `burnish fit-surface` to the byte, also where a rank is killed at a random moment and the
job is started again with --resume; and where one is killed while weights are found, after which rows have to be
resumed. A kill counts where the job ended by it: of three or more one has to. --time prints the seconds of one rank
and of two with a thread each, the least of three: all of a fit, and weights alone (--book); of four lobes to another
capture where it names one. Exits with 1 where something differs."""
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

TRIES = 5  # of a kill that may come too late
WIDE = 256  # texels along a side whose weights take long enough for a kill


def mpirun(ranks):
    return ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)]


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def ranks_of(launcher):
    """The processes that an mpirun started."""
    found = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(launcher.pid)], stdout=subprocess.PIPE, text=True)
    return [int(line.split()[0]) for line in found.stdout.splitlines() if "burnish" in line]


def killed_once(command, out, when):
    """Starts a job, kills one of its ranks when `when(job)` returns, and says whether the job ended by it."""
    out.unlink(missing_ok=True)
    with tempfile.TemporaryFile("w+") as said:
        job = subprocess.Popen(mpirun(2) + command, stdout=said, stderr=subprocess.STDOUT)
        when(job)
        ranks = ranks_of(job)
        for rank in random.sample(ranks, min(len(ranks), 1)):
            try:
                os.kill(rank, signal.SIGKILL)
            except ProcessLookupError:
                pass  # it came to its end
        status = job.wait()
        said.seek(0)
        text = said.read()
    by_kill = status != 0 and "signal 9" in text
    if status != 0 and not by_kill:
        sys.exit(f"{' '.join(map(str, command))}: exit {status}, and not by a kill\n{text}")
    return by_kill and not out.exists()


def resumed_rows(fit, out, height):
    """Of a job that is started again after a rank was killed while weights were found: rows that it already had."""
    part = pathlib.Path(f"{out}.part")

    def some_rows_are_saved(job):
        first = None  # bytes of the checkpoint without rows
        while job.poll() is None:
            if part.exists():
                try:
                    size = part.stat().st_size
                except FileNotFoundError:
                    continue  # it was removed, or is being replaced
                first = first or size
                if size > first:
                    return
            time.sleep(0.001)

    for _ in range(TRIES):
        part.unlink(missing_ok=True)
        if killed_once([*fit, "-o", out, "--resume", "--memory", "1M"], out, some_rows_are_saved):
            break
    else:
        sys.exit(f"expected a rank to be killed while weights are found, found the job's end {TRIES} times")
    report = json.loads(run(mpirun(2) + [*fit, "-o", out, "--resume", "--json"]))
    if not 0 < report["resumed_rows"] < height:
        sys.exit(f"expected some of {height} rows to be resumed, found {report['resumed_rows']}")
    return report["resumed_rows"]


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
        fit = [given.burnish_mpi, "fit-surface", capture, "-o", out, *OPTIONS, "--resume"]
        for _ in range(given.kills):
            moment = random.uniform(0.3, 1 + seconds)
            lost += killed_once([*fit, "--memory", "1M"], out, lambda _, moment=moment: time.sleep(moment))
        out.unlink(missing_ok=True)
        run(mpirun(2) + fit)
        if out.read_bytes() != alone.read_bytes():
            sys.exit("killed and started again: other bytes")
        print(f"a rank killed {given.kills} times, {lost} of them before the end: the same bytes")
        if given.kills >= 3 and lost == 0:
            sys.exit(f"expected one of {given.kills} kills to end a job, found none")

        if given.kills > 0:
            wide, weights, out = folder / "wide", folder / "weights.burnish", folder / "resumed.burnish"
            scene.write_text(json.dumps(SCENE | {"width": WIDE, "height": WIDE}))
            run([given.burnish, "measure", "--surface", scene, "-o", wide])
            known = ["fit-surface", wide, "--book", alone, "--threads", "1"]
            run([given.burnish, *known, "-o", weights])
            rows = resumed_rows([given.burnish_mpi, *known], out, WIDE)
            if out.read_bytes() != weights.read_bytes():
                sys.exit("killed while weights were found: other bytes")
            print(f"a rank killed while weights were found, {rows} of {WIDE} rows resumed: the same bytes")

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
