#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the examples by job: tests/examples/check.py BURNISH [JOB...] [--engine-loop PROGRAM] [--out FOLDER].

Each job of JOBS does what its first lines tell a reader to do, on a small model, and its answers are compared with the
command line's. A job whose tool is missing says so. Ends with 1 where a job fails, and with 77 where all that were asked
for were skipped. A file of examples/jobs has at most 149 lines, and a job here."""
import argparse
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples/jobs"
MODEL = "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.9/0.7/0.4,kd=0.1"


class Skipped(Exception):
    """A tool that this job needs is missing."""


def need(*tools):
    for tool in tools:
        if not shutil.which(tool):
            raise Skipped(f"{tool} is missing")


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=300, **options)
    if done.returncode:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def near(found, expected, most):
    for a, b in zip(found, expected, strict=True):
        assert abs(a - b) <= most, f"expected {expected}, found {found}"


class Jobs:
    def __init__(self, burnish, engine_loop, out):
        self.burnish, self.program, self.out = burnish, engine_loop, out
        self.model = out / "paint.burnish"

    def value(self, wi, wo):
        """What the command line gives for a pair of directions."""
        asked = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n" + ",".join(map(str, (*wi, *wo))) + "\n"
        said = run(self.burnish, "eval", self.model, "-", input=asked)
        return [float(number) for number in said.strip().split("\n")[-1].split(",")[-3:]]

    def fit(self):
        run(self.burnish, "fit", MODEL, "-o", self.model, "--model", "pqp", "--samples", "20000")

    def engine_loop(self):
        if not self.program:
            raise Skipped("no program of it was named (--engine-loop)")
        said = run(self.program, self.model, 2)
        assert len(re.findall(r"^frame \d: [1-9]\d+ pairs, mean 0\.\d*[1-9]", said, re.M)) == 2, said

    def webgpu_page(self):
        need("node", "chromium")
        if not (ROOT / "build/web/node_modules/playwright-core").exists():
            raise Skipped("playwright-core is missing from build/web (tests/web/check.sh installs it)")
        folder = self.out / "web"
        run(self.burnish, "export", self.model, "--to", "wgsl", "--to", "ktx2", "--plain", "-o", folder)
        shutil.copyfile(EXAMPLES / "webgpu_page.html", folder / "index.html")
        shutil.copyfile(ROOT / "tests/examples/webgpu.mjs", ROOT / "build/web/webgpu.mjs")
        said = run("node", ROOT / "build/web/webgpu.mjs", folder, 0.48, 0.36, 2).strip()
        if said == "no WebGPU":
            raise Skipped("Chromium has no WebGPU here")
        shown = [(2 * 0.8 * f) ** (1 / 2.2) for f in self.value((0.48, 0.36, 0.8), (0, 0, 1))]
        near([float(number) for number in said.split()], shown, 2 / 255)

    def mitsuba_scene(self):
        python = ROOT / "build/venv/bin/python"
        if not python.exists() or subprocess.run([python, "-c", "import mitsuba, burnish.mitsuba"],
                                                 capture_output=True).returncode:
            raise Skipped("build/venv has no mitsuba and burnish (make python)")
        said = run(python, EXAMPLES / "mitsuba_scene.py", self.model, "-o", self.out / "scene.png", "--samples", 16,
                   "--size", 24, "--variant", "scalar_rgb")
        mean, noise = map(float, re.search(r"mean ([\d.]+), noise ([\d.]+)", said).groups())
        assert 0.05 < mean < 1 and noise < mean, said
        assert (self.out / "scene.png").stat().st_size > 1000

    def slurm_batch(self):
        (self.out / "list.txt").write_text("lambert:kd=0.5\nlambert:kd=0.2\nno-such-file.binary\n")
        library = self.out / "library"
        done = subprocess.run([EXAMPLES / "slurm_batch.sh", self.out / "list.txt", library, "2"], capture_output=True,
                              text=True, timeout=300, env={**os.environ, "BURNISH": str(self.burnish)})
        # A material that cannot be fitted ends the batch with 1; the others are there all the same.
        assert done.returncode == 1, done.stdout + done.stderr
        assert "#SBATCH --array=1-2" in (library / "batch.slurm").read_text()
        assert len(re.findall(r"^\S.*: \d+ bytes, \d+\.\d dB$", done.stdout, re.M)) == 2, done.stdout
        assert "no-such-file" in done.stdout, done.stdout

    def cuda_kernel(self):
        run(self.burnish, "export", self.model, "--to", "cpp", "-o", self.out / "cuda")
        shutil.copy(EXAMPLES / "cuda_kernel.cu", self.out / "cuda")
        builds = [["g++", "-std=c++17", "-O2", "-x", "c++", "cuda_kernel.cu", "-o", "on_cpu"]]
        if shutil.which("nvcc"):
            builds.append(["nvcc", "-O3", "cuda_kernel.cu", "-o", "on_gpu"])
        else:
            print("cuda_kernel: nvcc is missing, so it is compiled for the processor alone")
        need("g++")
        for build in builds:
            run(*build, cwd=self.out / "cuda")
            if build[0] == "nvcc" and not shutil.which("nvidia-smi"):
                print("cuda_kernel: no GPU, so it is compiled and not run")
                continue
            said = run(self.out / "cuda" / build[-1])
            found = [float(number) for number in re.search(r"pair 0: (.*)", said).group(1).split()]
            near(found, [0.8 * f for f in self.value((0.6, 0, 0.8), (0, 0, 1))], 2e-6)

    def path_tracer(self):
        need("g++")
        folder = self.out / "paths"
        run(self.burnish, "export", self.model, "--to", "cpp", "--sample", "-o", folder)
        shutil.copy(EXAMPLES / "path_tracer.cu", folder)
        run("g++", "-std=c++17", "-O2", "-x", "c++", "path_tracer.cu", "-o", "paths", cwd=folder)
        said = run("./paths", "4", cwd=folder)
        mean, *sky = [float(number) for number in re.search(r"mean (\S+)\nsky: (\S+) (\S+) (\S+)", said).groups()]
        assert 0.1 < mean < 1 and (folder / "path_tracer.ppm").stat().st_size == 96 * 96 * 3 + 13, said
        # The same share by directions that are even in the cosine: pi times the mean of f.
        rows = []
        for i in range(128):
            for k in range(16):
                sine, phi = math.sqrt((i + 0.5) / 128), 2 * math.pi * (k + 0.5) / 16
                rows.append(f"{sine * math.cos(phi)},{sine * math.sin(phi)},{math.sqrt(1 - sine * sine)},0,0,1")
        asked = "\n".join(["wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", *rows]) + "\n"
        table = run(self.burnish, "eval", self.model, "-", input=asked)
        values = [[float(number) for number in row.split(",")[-3:]] for row in table.strip().split("\n")[1:]]
        near(sky, [math.pi * sum(row[c] for row in values) / len(values) for c in range(3)], 0.01)

    def highlight_pipe(self):
        need("iverilog")
        folder = self.out / "highlight"
        run(self.burnish, "hw", "generate", "--method", "w8", "--out-bits", 8, "--depth", 6, "--name", "highlight", "-o", folder)
        run("iverilog", "-g2012", "-f", "highlight.f", EXAMPLES / "highlight_pipe.sv", "-s", "highlight_pipe_tb", cwd=folder)
        said = run("./a.out", cwd=folder)
        assert "PASS 400 pixels" in said, said


JOBS = ["engine_loop", "webgpu_page", "mitsuba_scene", "slurm_batch", "cuda_kernel", "path_tracer", "highlight_pipe"]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("burnish", type=pathlib.Path)
    arguments.add_argument("jobs", nargs="*", metavar="JOB")
    arguments.add_argument("--engine-loop", type=pathlib.Path)
    arguments.add_argument("--out", type=pathlib.Path)
    given = arguments.parse_args()
    for job in given.jobs:
        if job not in JOBS:
            arguments.error(f"expected a job of {', '.join(JOBS)}, found '{job}'")
    wrong = [f"examples/jobs/{file.name}: expected a job in tests/examples/check.py"
             for file in EXAMPLES.iterdir() if file.stem not in JOBS]
    wrong += [f"examples/jobs/{file.name}: expected less than 150 lines" for file in EXAMPLES.iterdir()
              if len(file.read_text(encoding="utf-8").splitlines()) >= 150]
    jobs, skipped = given.jobs or JOBS, 0
    with tempfile.TemporaryDirectory() as scratch:
        out = given.out or pathlib.Path(scratch)
        out.mkdir(parents=True, exist_ok=True)
        made = Jobs(given.burnish.resolve(), given.engine_loop and given.engine_loop.resolve(), out.resolve())
        made.fit()
        for job in jobs:
            try:
                getattr(made, job)()
                print(f"{job}: ok")
            except Skipped as reason:
                skipped += 1
                print(f"{job}: SKIPPED: {reason}")
            except (AssertionError, subprocess.TimeoutExpired) as failure:
                wrong.append(f"{job}: {failure}")
    print("\n".join(wrong), end="\n" if wrong else "")
    return 1 if wrong else 77 if skipped == len(jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
