#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""damaged.py BURNISH FOLDER...: damaged files through the command line.

Takes the files of the folders (seeds that make_seeds writes, real measurements) and some that the program makes. It
damages them one by one in one of several ways, and gives each to a verb that reads such files. The program has to end
with 0 or 1. With 1 it says one line besides warnings, which names the file unless a fit failed, and leaves nothing
behind. With 0 it has written its output. A run takes below 1 GB and 5 s of the processor. Files that break these rules
are listed and kept in --keep, and the exit status is 1.
"""
import argparse
import collections
import multiprocessing
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

MOST_BYTES, MOST_SECONDS, LONGEST_ERROR = 1 << 30, 5, 299
LONGEST_LINE = 309  # of a conversion, which tells all that is lost
HANGS = 600  # seconds of the clock after which a program that uses no processor is ended too
LARGE = 100_000  # larger files, and networks of 800,000 weights, are taken once in SELDOM times: they take longer
SELDOM = 200
READS = ("info", "convert", "eval", "measure", "compare", "export")  # what does not more than read and write names the file
NO_SOURCE = {".f32", ".fit", ".ktx2", ".js", ".html"}
KINDS = {"directions": "eval", "capture": "capture", "btf": "capture", "np": "np", "mesh.obj": "mesh", "mesh.glb": "mesh",
         "environment.exr": "light", "illuminant": "illuminant", "neural": "neural", "book": "book"}
SPECS = {"neural": "nbrdf:{}#seed", "book": "book:{}#felt"}  # of one of several in a file
MODELS = {"model", "compact", "made.exr", "made.burnish"}
MADE = (["convert", "ggx:alpha_x=0.3", "made.binary", "--cells", "6"], ["convert", "ggx", "made.mbsdf", "--cells", "5"],
        ["convert", "openpbr", "made.bsdf"],
        ["convert", "ggx", "made.bin", "--to", "utia"], ["convert", "lambert", "zemax", "--to", "zemax"],
        ["convert", "ggx", "made.xml", "--cells", "8"], ["measure", "ggx", "-o", "cloud.csv", "--count", "99"],
        ["convert", "cloud.csv", "made.xompt"], ["convert", "ggx", "made.astm", "--count", "99"],
        ["convert", "ggx", "made.csv", "--count", "99"], ["convert", "ggx", "slices.exr", "--to", "exr"], ["fit", "ggx", "-o", "made.exr", "--budget", "1350"],
        ["convert", "made.exr", "made.burnish"], ["fit", "ggx", "-o", "nmf.json", "--method", "nmf"],
        ["fit", "ggx", "-o", "svd.json", "--method", "svd"], ["fit", "ggx", "-o", "openpbr.json", "--to", "openpbr", "--alone"],
        ["render", "--renderer", "cpu", "--material", "lambert", "--size", "16x8", "-o", "environment.exr"],
        ["export", "made.exr", "--to", "gltf", "-o", "."])
# Options for reading, which files of other formats pass over or refuse.
READ_OPTIONS = ["--brf", "--has-cosine", "--has-cosine-o", "--spectral", "--scale-to-tis", "--back", "--keep-negatives",
                *(f"--part={side}-{face}" for side in ("reflection", "transmission") for face in ("front", "back")),
                *(f"--band={band}" for band in ("Visible", "Solar", "CIE-XYZ", "CIE-X"))]
TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1 3 4\n"


def truncated(data, other, rng):
    return data[:rng.randrange(len(data))]


def flipped(data, other, rng):
    damaged = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
    return bytes(damaged)


def overwritten(data, other, rng):
    damaged = bytearray(data)
    word = rng.choice((b"\xff" * 4, b"\xff\xff\xff\x7f", b"\0" * 4, b"\0\0\xc0\x7f", b"\0\0\x80\x7f", b"\x01\0\0\0",
                       struct.pack("<d", float("nan")), struct.pack("<d", 1e300), struct.pack("<q", -1), b"\0\0\x10\0"))
    at = rng.randrange(len(damaged))
    damaged[at:at + len(word)] = word
    return bytes(damaged)


def cut_out(data, other, rng):
    at = rng.randrange(len(data))
    return data[:at] + data[at + rng.choice((1, 2, 8, 64, 1000)):]


def repeated(data, other, rng):
    at, count = rng.randrange(len(data)), rng.choice((1, 8, 64, 1000))
    return data[:at] + data[at:at + count] * rng.choice((2, 3, 50)) + data[at + count:]


def spliced(data, other, rng):
    return data[:rng.randrange(len(data))] + other[rng.randrange(len(other)):]


def renumbered(data, other, rng):
    """A number of a text becomes another; in a binary file, whatever bytes look like one."""
    places = [i for i in range(*sorted(rng.randrange(len(data) + 1) for _ in range(2))) if 48 <= data[i] <= 57]
    if not places:
        return overwritten(data, other, rng)
    start = end = rng.choice(places[:5000])
    while end < len(data) and (48 <= data[end] <= 57 or data[end] in b".eE"):
        end += 1
    number = rng.choice((b"-1", b"0", b"1e308", b"1e999", b"nan", b"inf", b"4294967296", b"99999999999999999999", b"-0.5",
                         b"1e-320", b"2147483647", b"65536", b"x", b""))
    return data[:start] + number + data[end:]


DAMAGES = (truncated, flipped, flipped, overwritten, cut_out, repeated, spliced, renumbered, renumbered)


def command_for(kind, path, out, rng):
    """What is run, and the file it writes."""
    if kind == "eval":
        return ["eval", "lambert", path, "-o", out], out
    if kind == "capture":
        return ["fit-surface", path, "-o", out, "--lobes", "1", "--lobe-bytes", "512", "--rounds", "1"], out
    if kind == "mesh":
        return ["render", "--renderer", "cpu", "--material", "lambert", "--size", "8", "--mesh", path, "-o", out + ".png"], out + ".png"
    if kind == "light":
        return ["render", "--renderer", "cpu", "--material", "lambert", "--vertices", "64", "--size", "4", "--draws", "1",
                "--environment", path, "-o", out + ".png"], out + ".png"
    if kind == "illuminant":
        return ["info", "lambert", "--illuminant", path], None
    if kind == "np":
        return ["info", f"np:{path}#seed"], None
    if kind in SPECS and rng.random() < 0.5:
        path = SPECS[kind].format(path)
    verb = rng.randrange(100)
    reading = [rng.choice(READ_OPTIONS)] if rng.random() < 0.3 else []
    if os.path.basename(path) in MODELS and verb % 10 == 0:
        return ["compare", "lambert", path, "--count", "20"], None
    if os.path.basename(path) in MODELS and verb % 10 == 1:
        return ["export", path, "--to", "glsl", "-o", out], out
    if verb < 60:
        return ["info", path] + reading + rng.choice(([], ["--json"], ["--illuminant", "D65"])), None
    if verb < 85:
        to = rng.choice(("csv", "csv", "astm", "openmaterial", "mbsdf", "tensortree", "burnish"))
        return ["convert", path, out, "--to", to] + reading + (["--count", "20"] if to in ("csv", "astm") else ["--cells", "4"] if to == "mbsdf" else []), out
    if verb < 95:
        return ["measure", path, "-o", out, "--count", "20"], out
    return ["fit", path, "-o", out + ".json", "--method", rng.choice(("analytic:ggx", "nmf", "svd"))], out + ".json"


def make_files(program, folder):
    """What the program itself writes."""
    pathlib.Path(folder, "mesh.obj").write_text(TRIANGLES)
    for command in MADE:
        subprocess.run([os.path.abspath(program), *command], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    for path in pathlib.Path(folder).glob("*.glb"):
        path.rename(path.with_name("mesh.glb"))


class Runner:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.out, self.err = folder + "/stdout", folder + "/stderr"

    def run(self, arguments):
        """Status, lines on the stream of errors, processor seconds, bytes at most."""
        flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC
        pid = os.posix_spawn(self.program, [self.program, *arguments], os.environ,
                             file_actions=[(os.POSIX_SPAWN_OPEN, 0, "/dev/null", os.O_RDONLY, 0),
                                           (os.POSIX_SPAWN_OPEN, 1, self.out, flags, 0o600),
                                           (os.POSIX_SPAWN_OPEN, 2, self.err, flags, 0o600)])
        resource.prlimit(pid, resource.RLIMIT_CPU, (4 * MOST_SECONDS, 4 * MOST_SECONDS))
        hang = threading.Timer(HANGS, os.kill, (pid, signal.SIGKILL))
        hang.start()
        _, status, usage = os.wait4(pid, 0)
        hang.cancel()
        said = pathlib.Path(self.err).read_bytes().decode(errors="replace")
        return os.waitstatus_to_exitcode(status), said, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def fault_of(verb, outcome, path, written):
    status, said, seconds, most = outcome
    if status == 2 and any(f"{option}: expected a source" in said for option in ("--count", "--cells")):
        return None  # the entries are written as they are, so the option means nothing
    if status not in (0, 1):
        return f"ended with {status}"
    if seconds > MOST_SECONDS:
        return f"took {seconds:.1f} s"
    if most > MOST_BYTES:
        return f"took {most >> 20} MiB"
    # Warnings of a reader come first, a line each. A conversion adds a line of what is lost and one of what changed.
    lines = said.splitlines()
    if any(not line.startswith("burnish: ") for line in lines):
        return "said more than a line"
    if any(": warning: " in line and len(line) > LONGEST_LINE + len(path) for line in lines):
        return "warned at length"
    lines = [line for line in lines if ": warning: " not in line]
    if len(lines) > (1 if status == 1 else 2) or any(len(line) > (LONGEST_ERROR if status == 1 else LONGEST_LINE)
                                                     for line in lines):
        return "said more than a line"
    if status == 1 and not lines:
        return "said nothing"
    said = "".join(lines)
    if status == 1 and verb in READS and os.path.dirname(path) not in said:
        return "said nothing of the file"
    if written and os.path.exists(written) != (status == 0):
        return "left its output" if status else "wrote nothing"
    return None


def sources(folders):
    """Kind and bytes of each file, small ones and large ones."""
    small, large = [], []
    for folder in folders:
        for path in sorted(p for p in pathlib.Path(folder).rglob("*") if p.is_file()):
            data = path.read_bytes()
            if not data or path.suffix in NO_SOURCE or path.name == "codes.csv":  # parts of sources
                continue
            kind = KINDS.get(path.name, "source")
            (small if len(data) <= LARGE and kind != "np" else large).append((kind, path.name, data))
    return small, large


class Trial:
    """Damages and runs by number, in a folder of the process's own."""

    def __init__(self, arguments, made):
        small, large = sources([made, *arguments.folders])
        self.arguments, self.small, self.large, self.runner = arguments, small, large, None
        self.decoder = next((str(p.resolve()) for f in arguments.folders for p in pathlib.Path(f).rglob("decoder.f32")), None)

    def __call__(self, number):
        """The verb, the file's name, (status, said, seconds, bytes), and what was wrong, if anything."""
        if self.runner is None:
            self.runner = Runner(os.path.abspath(self.arguments.burnish), tempfile.mkdtemp(dir=self.arguments.work))
        rng = random.Random(f"{self.arguments.seed} {number}")
        kind, name, data = rng.choice(self.large if self.large and number % SELDOM == 0 else self.small)
        damage = rng.choice(DAMAGES)
        damaged = damage(data, rng.choice(self.small)[2], rng)
        with tempfile.TemporaryDirectory(dir=self.runner.folder) as folder:
            if self.decoder and kind == "np":
                os.symlink(self.decoder, folder + "/decoder.f32")
            path = folder + "/" + ("codes.csv" if kind == "np" else "capture.json" if name == "capture" else name)
            pathlib.Path(path).write_bytes(damaged)
            command, written = command_for(kind, folder if kind == "np" or name == "capture" else path, folder + "/out", rng)
            outcome = self.runner.run(command)
            fault = fault_of(command[0], outcome, path, written)
        if fault:
            os.makedirs(self.arguments.keep, exist_ok=True)
            kept = os.path.join(self.arguments.keep, f"{self.arguments.seed}-{number}-{os.path.basename(path)}")
            pathlib.Path(kept).write_bytes(damaged)
            fault = f"{kept}: {damage.__name__}: {fault}: {' '.join(command)}: {outcome[1][:400].strip()}"
        return command[0], name, outcome, fault


def try_one(number):
    return trial(number)


def main():
    global trial
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--files", type=int, default=100_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes; what is tried does not depend on it")
    parser.add_argument("--seed", type=int, default=1, help="of the damage; the same seed damages alike")
    parser.add_argument("--keep", default="build/damaged/kept", help="folder for what fails")
    arguments = parser.parse_args()
    began, done, faults, slowest, largest = time.time(), 0, 0, (0, ""), (0, "")
    counts = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="burnish_damaged_") as arguments.work:
        os.makedirs(arguments.work + "/made")
        make_files(arguments.burnish, arguments.work + "/made")
        trial = Trial(arguments, arguments.work + "/made")  # which processes inherit
        numbers = range(arguments.first, arguments.first + arguments.files)
        with multiprocessing.get_context("fork").Pool(arguments.jobs) as pool:
            for verb, name, outcome, fault in pool.imap_unordered(try_one, numbers, chunksize=20):
                done += 1
                counts[f"{verb} {outcome[0]}"] += 1
                slowest, largest = max(slowest, (outcome[2], name)), max(largest, (outcome[3], name))
                if fault:
                    faults += 1
                    print(fault, flush=True)
                if done % 1000 == 0:
                    print(f"{done} files, {faults} faults, {time.time() - began:.0f} s", file=sys.stderr, flush=True)
    print(f"{done} damaged files of {len(trial.small) + len(trial.large)}: {faults} faults; at most {slowest[0]:.2f} s "
          f"({slowest[1]}) and {largest[0] / 2**20:.0f} MiB ({largest[1]}); verbs and how they ended: "
          + ", ".join(f"{what}: {count}" for what, count in sorted(counts.items())))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
