#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A library of 1,000 beside its fits one by one: tests/library/scale.py BURNISH [--count N] [--cells C] [FIT OPTIONS].

Of COUNT materials 5 % are damaged files, 25 % analytic, the rest MERL files of C x C x 2 C cells: twenty stand-ins of
BURNISH_DATA/np in other and other colours. FIT OPTIONS are those of `burnish fit`, by default --model pqp. Prints what
was fitted and what failed, the processor time of the batch over that of its fits one by one, its largest memory, and
how long the table takes to answer. Exits with 1 where a good material is missing, a damaged one is not named with its
reason, a model has other bits than its fit alone, or more was taken than MOST_PROCESSOR_TIME, --memory or
MOST_QUERY_SECONDS."""
import argparse
import array
import json
import os
import pathlib
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time

STAND_INS = 20
MOST_PROCESSOR_TIME = 1.1  # of a batch, of its fits one by one
MOST_QUERY_SECONDS = 0.05
UNITS = {"K": 1 << 10, "M": 1 << 20, "G": 1 << 30}


def check(condition, message):
    if not condition:
        sys.exit(f"scale.py: {message}")


def mebibytes(size):
    """Of a size as --memory takes it: 500M, 4G or bytes."""
    unit = UNITS.get(size[-1].upper())
    return (float(size[:-1]) * unit if unit else float(size)) / UNITS["M"]


def timed(command):
    """Exit code, what was printed, processor seconds and the largest memory in MiB."""
    with tempfile.TemporaryFile("w+") as said:
        streams = [(os.POSIX_SPAWN_DUP2, said.fileno(), 1), (os.POSIX_SPAWN_OPEN, 2, os.devnull, os.O_WRONLY, 0)]
        pid = os.posix_spawnp(command[0], command, os.environ, file_actions=streams)
        _, status, usage = os.wait4(pid, 0)
        said.seek(0)
        return os.waitstatus_to_exitcode(status), said.read(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def stand_ins(burnish, data, folder, cells):
    names = [line.split(",")[0] for line in (data / "np/codes.csv").read_text().splitlines()]
    chosen = [name for name in names if not name.endswith("_rgb")][::5][:STAND_INS]
    tables = []
    for name in chosen:
        subprocess.run([burnish, "convert", f"np:{data}/np#{name}", folder / f"{name}.binary", "--cells", str(cells)],
                       check=True, stderr=subprocess.DEVNULL)
        tables.append((folder / f"{name}.binary").read_bytes())
        (folder / f"{name}.binary").unlink()
    return tables


def coloured(table, k):
    """A MERL file in other colours: its planes times three numbers."""
    head, values = table[:12], array.array("d", table[12:])
    plane = len(values) // 3
    for channel in range(3):
        factor = 0.3 + 0.7 * ((k * (7 + 4 * channel)) % 101) / 101
        for at in range(channel * plane, (channel + 1) * plane):
            values[at] *= factor
    return head + values.tobytes()


def make_library(burnish, data, folder, count, cells):
    """(arguments, those that are damaged)."""
    tables = stand_ins(burnish, data, folder, cells)
    arguments, damaged = [], []
    for k in range(count):
        if k % 20 == 7:
            path = folder / f"damaged{k}.binary"
            kinds = [b"", b"nothing of the kind", tables[0][:5000], struct.pack("<3i", -1, 7, 1 << 30)]
            path.write_bytes(kinds[k // 20 % 4])
            damaged.append(str(path))
        elif k % 4 == 1:
            alpha, green = 0.05 + 0.0005 * k, 0.1 + k / 2000
            arguments.append(f"ggx:alpha_x={alpha:.4f},alpha_y={alpha:.4f},f0=0.9/{green:.4f}/0.2")
        else:
            path = folder / f"stand-in{k}.binary"
            path.write_bytes(coloured(tables[k % len(tables)], k) if k >= len(tables) else tables[k])
            arguments.append(str(path))
    return arguments, damaged


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--cells", type=int, default=32)
    parser.add_argument("--memory", default="500M")
    parser.add_argument("--keep", type=pathlib.Path, help="leave the batch in this folder")
    arguments, how = parser.parse_known_args()
    how = how or ["--model", "pqp"]
    burnish, data = os.path.abspath(arguments.burnish), os.environ.get("BURNISH_DATA")
    if not data:
        sys.exit("scale.py: expected BURNISH_DATA to name the measurements")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        good, damaged = make_library(burnish, pathlib.Path(data), folder, arguments.count, arguments.cells)
        (folder / "list").write_text("\n".join(sorted(good + damaged)))
        out = arguments.keep or folder / "out"
        start = time.monotonic()
        code, said, seconds, memory = timed([burnish, "batch", str(folder / "list"), "-o", str(out), "--json",
                                             "--memory", arguments.memory, *how])
        wall = time.monotonic() - start
        summary = json.loads(said)
        print(f"{summary['fitted']} of {len(good)} good ones fitted, "
              f"{summary['failed']} of {len(damaged)} damaged ones named")
        print(f"{seconds:.1f} s of processor time, {wall:.1f} s by the clock, {memory:.0f} MiB of {arguments.memory}")
        check(memory <= mebibytes(arguments.memory), f"expected at most {arguments.memory}, found {memory:.0f} MiB")
        reasons = {failure["path"]: failure["reason"] for failure in summary["failures"]}
        if code != 1 or summary["fitted"] != len(good) or set(reasons) != set(damaged) or not all(reasons.values()):
            sys.exit(f"scale.py: expected every good one fitted and every damaged one named, found exit code {code}")

        alone = 0
        with sqlite3.connect(out / "library.sqlite") as table:
            models = dict(table.execute("SELECT path, file FROM materials WHERE reason IS NULL"))
        for argument in good:
            code, _, one, _ = timed([burnish, "fit", argument, "-o", str(folder / "alone.burnish"), *how])
            alone += one
            if (folder / "alone.burnish").read_bytes() != (out / models[argument]).read_bytes():
                sys.exit(f"scale.py: {argument}: expected the bits of its fit alone, found others")
        print(f"{alone:.1f} s for the fits one by one, the same bits: {seconds / alone:.3f} times as much")
        check(seconds <= MOST_PROCESSOR_TIME * alone,
              f"expected at most {MOST_PROCESSOR_TIME} times as much processor time, found {seconds / alone:.3f}")

        best = min(query_time(out / "library.sqlite") for _ in range(5))
        print(f"SELECT name FROM materials WHERE psnr < 40: {1000 * best:.1f} ms")
        check(best <= MOST_QUERY_SECONDS, f"expected the query in {1000 * MOST_QUERY_SECONDS:.0f} ms")


def query_time(path):
    start = time.monotonic()
    with sqlite3.connect(path) as table:
        table.execute("SELECT name FROM materials WHERE psnr < 40").fetchall()
    return time.monotonic() - start


if __name__ == "__main__":
    main()
