#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills batches at random moments and takes their folder away: tests/library/kill.py BURNISH [--kills N] [--seed S].

A library of analytic materials and damaged files is fitted undisturbed. Then it is fitted again, killed by SIGKILL
at random moments and resumed, N kills in all. Expected: the same bits, and no material begun again whose journal
said that it was fitted. Then its folder is full (a tmpfs), read-only and moved away meanwhile. Expected: exit code 1
and one line that says so, nothing lost that was finished, and the same bits when it is resumed. Mounting takes root:
without it these two are said to be skipped, and the exit code is 77. Prints what was found, and exits with 1 where
something else was."""
import argparse
import collections
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

MATERIALS = [f"{name}:alpha_x={alpha},alpha_y={alpha}" for name in ("ggx", "ward", "beckmann")
             for alpha in (0.1, 0.15, 0.2, 0.25, 0.3, 0.4)]
HOW = ["--model", "pqp", "--samples", "5000", "--threads", "2"]
SKIPPED = 77  # as CTest's SKIP_RETURN_CODE has it
PATIENCE = 180  # seconds; the batch's own is 60, after which it takes over a claim that has no lines yet


def check(condition, message):
    if not condition:
        sys.exit(f"kill.py: {message}")


def contents(folder):
    """Bytes of models and pictures by name."""
    return {str(path.relative_to(folder)): path.read_bytes() for below in ("models", "pictures")
            for path in sorted((folder / below).glob("*"))}


def events(folder):
    """(name, key) -> kinds of events in the order that processes wrote them; a torn line is none."""
    found = collections.defaultdict(list)
    for path in sorted((folder / "journal").glob("*.jsonl"), key=lambda file: file.stat().st_mtime_ns):
        for line in path.read_text().splitlines():
            try:
                entry = json.loads(line)
            except ValueError:
                continue
            if "name" in entry:
                found[entry["name"], entry["key"]].append(entry["event"])
    return found


class Library:
    def __init__(self, burnish, scratch):
        self.burnish, self.list = burnish, scratch / "list"
        (scratch / "damaged.binary").write_bytes(b"\x20\0\0\0\x20\0\0\0\x40\0\0\0 cut")
        self.list.write_text("\n".join([*MATERIALS, str(scratch / "damaged.binary"), str(scratch / "missing.csv")]))

    def start(self, folder, *more):
        return subprocess.Popen([self.burnish, "batch", self.list, "-o", folder, "--resume", *HOW, *more],
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def finish(self, folder):
        """Whole but for the two that cannot be fitted."""
        process = self.start(folder)
        said = process.communicate(timeout=PATIENCE)[1]
        check(process.returncode == 1 and f"2 of {len(MATERIALS) + 2} materials" in said,
              f"expected two failures, found {process.returncode}: {said}")

    def fail(self, folder, what):
        process = self.start(folder)
        said = process.communicate(timeout=PATIENCE)[1]
        check(process.returncode == 1 and what in said and said.count("\n") == 1,
              f"expected one line with '{what}', found {process.returncode}: {said}")
        return said.strip()


def check_nothing_done_twice(folder):
    again = [name for (name, _), kinds in events(folder).items()
             if "fitted" in kinds and (kinds.count("fitted") > 1 or "began" in kinds[kinds.index("fitted"):])]
    check(not again, f"expected no finished fit to be done again, found {again}")


def kill_often(library, scratch, undisturbed, seconds, kills, draw):
    done, rounds, in_fits = 0, 0, 0
    while done < kills:
        folder = scratch / f"killed-{rounds}"
        rounds += 1
        while done < kills:
            process = library.start(folder)
            try:
                process.wait(timeout=draw.uniform(0.01, seconds / 3))
                break
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
                done += 1
        begun = [kinds for kinds in events(folder).values()] if (folder / "journal").exists() else []
        in_fits += sum(kinds.count("began") - 1 for kinds in begun if "fitted" in kinds)
        library.finish(folder)
        check(contents(folder) == undisturbed, "expected the bits of the undisturbed run after kills, found others")
        check_nothing_done_twice(folder)
    print(f"killed {done} times in {rounds} batches ({in_fits} fits were cut short): the same bits, nothing done twice")


def check_kept(folder, undisturbed):
    """What the journal says is fitted is there, whole, under its name or the one it was written under."""
    for (name, _), kinds in events(folder).items():
        if "fitted" in kinds:
            model = folder / "models" / f"{name}.burnish"
            staged = list((folder / "staging").glob(f"{name}.0.*"))
            bytes_ = model.read_bytes() if model.exists() else staged[0].read_bytes()
            check(bytes_ == undisturbed[f"models/{name}.burnish"], f"expected {name} to be kept, found other bytes")
    return sum("fitted" in kinds for kinds in events(folder).values())


def mount(*arguments):
    return subprocess.run(["mount", *arguments], capture_output=True).returncode == 0


def full_and_read_only(library, scratch, undisturbed):
    """Whether it could be tried."""
    place = scratch / "small"
    place.mkdir()
    if not mount("-t", "tmpfs", "-o", "size=120k", "none", str(place)):
        print("full and read-only folders: SKIPPED, mounting takes root")
        return False
    try:
        said = library.fail(place / "out", "No space left on device")
        kept = check_kept(place / "out", undisturbed)
        check(kept > 0, "expected some fits before the disk was full, found none")
        print(f"full after {kept} fits, which are kept: {said}")
        mount("-o", "remount,ro", str(place))
        print(f"read-only: {library.fail(place / 'out', 'Read-only file system')}")
        mount("-o", "remount,rw,size=50m", str(place))
        library.finish(place / "out")
        check(contents(place / "out") == undisturbed, "expected the undisturbed bits once there is room, found others")
        check_nothing_done_twice(place / "out")
    finally:
        subprocess.run(["umount", str(place)], check=True)
    return True


def vanished(library, scratch, undisturbed, seconds):
    folder, elsewhere = scratch / "vanishing", scratch / "elsewhere"
    process = library.start(folder)
    while process.poll() is None and not any("fitted" in kinds for kinds in events(folder).values()):
        time.sleep(seconds / 100)
    folder.rename(elsewhere)
    said = process.communicate(timeout=PATIENCE)[1]
    check(process.returncode == 1 and said.count("\n") == 1 and "vanishing" in said,
          f"expected one line on the folder that vanished, found {process.returncode}: {said}")
    kept = check_kept(elsewhere, undisturbed)
    elsewhere.rename(folder)
    library.finish(folder)
    check(contents(folder) == undisturbed, "expected the undisturbed bits once the folder is back, found others")
    check_nothing_done_twice(folder)
    print(f"vanished after {kept} fits, which are kept: {said.strip()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=None, help="of the moments; by default another each time")
    arguments = parser.parse_args()
    seed = arguments.seed if arguments.seed is not None else random.randrange(1 << 32)
    print(f"seed {seed}")
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        library = Library(os.path.abspath(arguments.burnish), scratch)
        start = time.monotonic()
        library.finish(scratch / "undisturbed")
        seconds = time.monotonic() - start
        undisturbed = contents(scratch / "undisturbed")
        check(len(undisturbed) == 2 * len(MATERIALS), f"expected {len(MATERIALS)} models and pictures")
        kill_often(library, scratch, undisturbed, seconds, arguments.kills, random.Random(seed))
        vanished(library, scratch, undisturbed, seconds)
        if not full_and_read_only(library, scratch, undisturbed):
            sys.exit(SKIPPED)


if __name__ == "__main__":
    main()
