#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the outputs of the command line to the bit: their SHA-256 against hashes.txt, for the commands in commands.txt.

Each command runs twice, once on one processor and once on all, which must give the same bits. What depends on
floating-point arithmetic is compared on machines of a recorded kind only: processor, compiler, C library and BLAS.
Text that does not is compared everywhere. Beside a model whose bits differ stand its error figures, old and new.
To see what changed in a file: --record --keep OLD with the old binary, --keep NEW with the new one, and a diff."""
import argparse
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import platform
import queue
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass

HERE = pathlib.Path(__file__).resolve().parent
COMMANDS, HASHES = HERE / "commands.txt", HERE / "hashes.txt"
PROCESSES = 2  # at a time
TEXT_SUFFIXES = {".c", ".cu", ".f", ".glsl", ".hlsl", ".mem", ".metal", ".rs", ".sv", ".txt", ".wgsl"}
FIGURES = ["psnr", "ssim", "relative", "log_cos", "rms_log"]


@dataclass
class Command:
    section: str
    output: str
    arguments: list
    stdin: str = ""

    def needs_data(self):
        return any("data/" in argument for argument in self.arguments)

    def text(self):
        return "burnish " + shlex.join(self.arguments) + (f" < {self.stdin}" if self.stdin else "")


def read_commands():
    commands, section = [], ""
    for line in COMMANDS.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        if line.startswith("["):
            section = line.strip("[]")
            continue
        output, *arguments = shlex.split(line)
        stdin = ""
        if "<" in arguments:
            stdin = arguments[-1]
            arguments = arguments[:-2]
        commands.append(Command(section, output, arguments, stdin))
    return commands


def with_what_they_need(chosen, commands):
    """`chosen` and the commands that make their inputs, in the order of the list."""
    made_by = {command.output: command for command in commands}
    needed, left = set(), list(chosen)
    while left:
        command = left.pop()
        if command.output not in needed:
            needed.add(command.output)
            left += [made_by[word] for word in command.arguments if word in made_by]
    return [command for command in commands if command.output in needed]


def write_inputs(folder):
    """Directions, cosines and words from integers and square roots, which are the same everywhere."""
    grid = range(-4, 5)
    directions = [(x / 5, y / 5, math.sqrt(1 - (x * x + y * y) / 25)) for x in grid for y in grid if x * x + y * y < 25]
    pairs = [(wi, directions[(7 * i + 3) % len(directions)]) for i, wi in enumerate(directions)]
    rows = [",".join(repr(value) for value in wi + wo) for wi, wo in pairs]
    (folder / "directions.csv").write_text("\n".join(["wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"] + rows) + "\n")
    (folder / "cosines.txt").write_text("".join(f"{i / 256}\n" for i in range(257)))
    words = [f"{exponent} {32768 - word}\n" for exponent in (1, 7, 50, 1000) for word in range(0, 4096, 97)]
    (folder / "words.txt").write_text("".join(words))


class Runner:
    """Runs commands in a folder of their own, where every file has a relative name."""

    def __init__(self, burnish, folder, processors):
        self.burnish, self.folder, self.processors = burnish, folder, processors
        folder.mkdir()
        write_inputs(folder)
        if os.environ.get("BURNISH_DATA"):
            (folder / "data").symlink_to(os.environ["BURNISH_DATA"])

    def burnish_prints(self, arguments, stdin=""):
        # OpenBLAS chooses its kernels by processor: not here.
        environment = dict(os.environ, OPENBLAS_CORETYPE="Haswell", LC_ALL="C")
        given = (self.folder / stdin).read_bytes() if stdin else b""
        done = subprocess.run([self.burnish, *arguments], cwd=self.folder, env=environment, input=given,
                              capture_output=True)
        if done.returncode != 0:
            raise RuntimeError(f"burnish {shlex.join(arguments)}\n    exit status {done.returncode}: "
                               + done.stderr.decode(errors="replace").strip()[-1000:])
        return done.stdout

    def run(self, command):
        processors = self.processors.get()
        os.sched_setaffinity(0, processors)  # of this thread, and so of its children
        try:
            arguments = [command.output if word == "@" else word for word in command.arguments]
            printed = self.burnish_prints(arguments, command.stdin)
            if "@" not in command.arguments:
                (self.folder / command.output).write_bytes(printed)
        finally:
            self.processors.put(processors)

    def hashes(self, command):
        """Path -> SHA-256 of every file of the command."""
        made = self.folder / command.output
        files = sorted(path for path in made.rglob("*") if path.is_file()) if made.is_dir() else [made]
        return {str(path.relative_to(self.folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}

    def figures(self, command):
        """What `compare` says of a fitted model, rounded to six digits."""
        source = command.arguments[1]
        found = json.loads(self.burnish_prints(["compare", "--json", source, command.output]))[0]
        return {name: "none" if found[name] is None else f"{found[name]:.6g}" for name in FIGURES}


def run_all(runners, commands):
    """Section by section, some commands at a time. Returns what failed, in the order of the list."""
    with concurrent.futures.ThreadPoolExecutor(PROCESSES) as pool:
        for section in dict.fromkeys(command.section for command in commands):
            jobs = [pool.submit(runner.run, command) for command in commands if command.section == section
                    for runner in runners]
            failures = [str(job.exception()) for job in jobs if job.exception()]
            if failures:
                return failures
    return []


def vectors():
    info = pathlib.Path("/proc/cpuinfo")
    text = info.read_text() if info.exists() else ""
    flags = re.search(r"^flags\s*: (.*)$", text, re.M)
    vendor = re.search(r"^vendor_id\s*: (.*)$", text, re.M)
    if not flags:
        return platform.machine()
    has = set(flags.group(1).split())
    if {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"} <= has:
        best = "avx512"
    elif {"avx2", "fma", "bmi2", "f16c"} <= has:
        best = "avx2"
    else:
        best = "sse"
    # Approximate reciprocals differ among makers.
    return f"{vendor.group(1) if vendor else 'unknown'}-{best}"


def kind_of_machine(burnish):
    """What the bits may depend on."""
    compiler = re.search(rb"GCC: \([^)]*\) (\d+)", pathlib.Path(burnish).read_bytes())
    libraries = subprocess.run(["ldd", burnish], capture_output=True, text=True).stdout
    blas = re.search(r"libopenblas\S* => (\S+)", libraries)
    blas = pathlib.Path(blas.group(1)).resolve() if blas else None
    return " ".join([vectors(), f"g++-{compiler.group(1).decode()}" if compiler else "another-compiler",
                     "-".join(platform.libc_ver()), f"{blas.parent.name}/{blas.name}" if blas else "no-openblas"])


def read_record():
    """Section -> path -> SHA-256, and kind of machine -> path -> figures."""
    hashes, figures, section = {}, {}, ""
    for line in HASHES.read_text().splitlines() if HASHES.exists() else []:
        if line.startswith("["):
            section = line.strip("[]")
            hashes[section], figures[section] = {}, {}
        elif line.startswith("figures "):
            _, path, *pairs = line.split()
            figures[section][path] = dict(pair.split("=") for pair in pairs)
        elif line and not line.startswith("#"):
            digest, path = line.split("  ")
            hashes[section][path] = digest
    return hashes, figures


def write_record(hashes, figures):
    lines = ["# Written by check.py --record: SHA-256 of outputs, and error figures of fitted models."]
    for section in sorted(hashes, key=lambda name: (name != "text", name)):
        lines += ["", f"[{section}]"]
        lines += [f"{hashes[section][path]}  {path}" for path in sorted(hashes[section])]
        for path, values in sorted(figures.get(section, {}).items()):
            lines.append(f"figures {path} " + " ".join(f"{name}={values[name]}" for name in FIGURES))
    HASHES.write_text("\n".join(lines) + "\n")


def is_text(command, path):
    return command.section == "text" and pathlib.Path(path).suffix in TEXT_SUFFIXES


def keep(folder, runner, path):
    if folder:
        kept = folder / runner.folder.name / path
        kept.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(runner.folder / path, kept)
        return f" (kept: {kept})"
    return ""


def judged(was, runner, command):
    """A model's figures as recorded and now: whether other bits are worse ones."""
    try:
        now = runner.figures(command)
    except RuntimeError as error:
        return f"\n    cannot be compared: {error}"
    return "".join(f"\n    {name:<9} was {was[name]:>10}, is {now[name]:>10}" for name in FIGURES)


def differences(once, again, commands, record, kind, folder):
    """One message for each file that is not what is recorded, or not the same twice."""
    hashes, figures = record
    messages = []
    for command in commands:
        found, repeated = once.hashes(command), again.hashes(command)
        known = {section: {path: digest for path, digest in hashes.get(section, {}).items()
                           if path.split("/")[0] == command.output} for section in ("text", kind)}
        for path in sorted(found.keys() | repeated.keys()):
            if found.get(path) != repeated.get(path):
                for runner, made in ((once, found), (again, repeated)):
                    if path in made:
                        keep(folder, runner, path)
                messages.append(f"{path}: differs between a run on one processor and a run on all\n    {command.text()}")
        for path, digest in found.items():
            section = "text" if is_text(command, path) else kind
            if section not in hashes:
                continue
            old = known[section].pop(path, None)
            if old == digest:
                continue
            what = f"{path}: {'is not recorded' if old is None else 'differs'}{keep(folder, once, path)}\n"
            what += f"    {command.text()}"
            if path in figures.get(kind, {}):
                what += judged(figures[kind][path], once, command)
            messages.append(what)
        messages += [f"{path}: recorded, but no longer written\n    {command.text()}" for section in known
                     for path in known[section]]
    return messages


def record_all(once, commands, skipped, kind):
    """Replaces what this kind of machine has recorded, but of commands that did not run."""
    hashes, figures = read_record()
    outputs = {command.output for command in skipped}
    for section in ("text", kind):
        for kept in (hashes, figures):
            old = kept.get(section, {})
            kept[section] = {path: value for path, value in old.items() if path.split("/")[0] in outputs}
    for command in commands:
        for path, digest in once.hashes(command).items():
            hashes["text" if is_text(command, path) else kind][path] = digest
        if command.arguments[0] == "fit":
            figures[kind][command.output] = once.figures(command)
    write_record(hashes, figures)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish", help="the command line")
    parser.add_argument("--record", action="store_true", help="write hashes.txt, for this kind of machine")
    parser.add_argument("--keep", metavar="FOLDER", type=pathlib.Path,
                        help="copy files that differ into FOLDER (with --record every file)")
    arguments = parser.parse_args()
    burnish = str(pathlib.Path(arguments.burnish).resolve())

    kind, record = kind_of_machine(burnish), read_record()
    print(f"machine: {kind}")
    commands, skipped = read_commands(), []
    listed = commands
    if not os.environ.get("BURNISH_DATA"):
        skipped = [command for command in commands if command.needs_data()]
        commands = [command for command in commands if not command.needs_data()]
        print(f"skipped: {len(skipped)} commands on real measurements, which BURNISH_DATA does not name")
    if not arguments.record and kind not in record[0]:
        commands = with_what_they_need([c for c in commands if c.section == "text"], commands)
        print(f"skipped: all but {len(commands)} of {len(listed)} commands, because no outputs are recorded for "
              "this kind of machine; text is compared")

    with tempfile.TemporaryDirectory() as scratch:
        for name in ("once", "again") if arguments.keep else []:  # of an earlier run
            shutil.rmtree(arguments.keep / name, ignore_errors=True)
        available = sorted(os.sched_getaffinity(0))
        one, all_of_them = queue.Queue(), queue.Queue()
        for i in range(PROCESSES):
            one.put({available[i % len(available)]})
            all_of_them.put(set(available))
        once = Runner(burnish, pathlib.Path(scratch) / "once", one)
        again = Runner(burnish, pathlib.Path(scratch) / "again", all_of_them)
        failures = run_all([once, again], commands)
        if failures:
            sys.exit("\n".join(failures))
        if arguments.record:
            changing = differences(once, again, commands, ({}, {}), kind, arguments.keep)
            if changing:
                sys.exit("\n".join(changing))
            record_all(once, commands, skipped, kind)
            for command in commands if arguments.keep else []:
                for path in once.hashes(command):
                    keep(arguments.keep, once, path)
        else:
            changed = differences(once, again, commands, record, kind, arguments.keep)
            if changed:
                sys.exit("\n".join(changed) + f"\n{len(changed)} outputs differ")
        count = sum(len(once.hashes(command)) for command in commands)
    print(f"{len(commands)} commands, {count} files: {'recorded' if arguments.record else 'the same bits'}")


if __name__ == "__main__":
    main()
