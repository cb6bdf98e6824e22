#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scores what is made of scattered samples against the BRDFs that they were drawn from, beside what others make of them.

    tests/scattered/score.py BURNISH FILE.bsdf... [--counts 300,3000,30000] [--page docs/results/scattered.md]

Samples: pairs even in theta_h, theta_d and phi_d with both cosines above 0.05, as `burnish measure` draws them, and
"8 x 180": eight angles of incidence, half of the views about the mirror direction. Values are the mean of both orders of
the directions, with log-normal noise of 5 %. Figures: psnr of three lit spheres of 128 x 128, `relative` and `log_cos`
as `burnish compare` defines them, over 20,000 other pairs.

Rows: `fit`, the model of `burnish fit`; `function`, the samples themselves by `burnish eval`; and, over
ln(f + 1e-3) in the coordinates of half and difference angles, thin-plate splines of 40 neighbours (scipy), a Gaussian
process (scikit-learn, Matern 3/2, parameters of 500 samples; 30,000 would take 7 GB), the mean of five neighbours by
inverse distance. `within 90 %`: the share of other readings whose logarithm lies within 1.645 deviations of
`burnish eval --error` and the noise. `next`: the error of the function once 20 samples of `burnish measure --next` are
added to 200, three times, over that of random ones. Needs numpy, scipy, scikit-learn."""
import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.spatial import cKDTree

NOISE, FLOOR, SIZE = 0.05, 1e-3, 128
BURNISH = None


def run(*command):
    """What a command of burnish prints, and its processor time."""
    before = os.times()
    done = subprocess.run([BURNISH, *map(str, command)], capture_output=True, text=True)
    after = os.times()
    if done.returncode:
        sys.exit(f"burnish {' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout, (after.children_user - before.children_user + after.children_system - before.children_system)


def evaluate(brdf, wi, wo, *options):
    with tempfile.TemporaryDirectory() as folder:
        directions, values = pathlib.Path(folder, "directions.csv"), pathlib.Path(folder, "values.csv")
        np.savetxt(directions, np.concatenate([wi, wo], -1), delimiter=",", fmt="%.9g", comments="",
                   header="wi_x,wi_y,wi_z,wo_x,wo_y,wo_z")
        run("eval", brdf, directions, "-o", values, *options)
        return np.loadtxt(values, delimiter=",", skiprows=1, ndmin=2)


# ---- Directions

def direction(theta, phi):
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def drawn_pairs(count, seed):
    random = np.random.default_rng(seed)
    theta_h, theta_d = random.uniform(0, np.pi / 2, (2, 3 * count))
    phi_d = random.uniform(0, 2 * np.pi, 3 * count)
    d = direction(theta_d, phi_d)

    def about_y(v):
        return np.stack([np.cos(theta_h) * v[:, 0] + np.sin(theta_h) * v[:, 2], v[:, 1],
                         np.cos(theta_h) * v[:, 2] - np.sin(theta_h) * v[:, 0]], -1)

    wi, wo = about_y(d), about_y(d * [-1, -1, 1])
    kept = np.minimum(wi[:, 2], wo[:, 2]) > 0.05
    return wi[kept][:count], wo[kept][:count]


def incidences(count=8, views=180, seed=5):
    random, all_wi, all_wo = np.random.default_rng(seed), [], []
    for theta in np.radians(np.linspace(5, 75, count)):
        wi = direction(theta, 0.0)
        broad = direction(np.arccos(np.sqrt(random.uniform(0.01, 1, views // 2))),
                          random.uniform(0, 2 * np.pi, views // 2))
        off = np.tan(np.radians(20)) * np.abs(random.standard_normal((8 * views, 1)))
        near = unit(wi * [-1, -1, 1] + off * unit(random.standard_normal((8 * views, 3))))
        wo = np.concatenate([broad, near[near[:, 2] > 0.1][:views - views // 2]])
        all_wi.append(np.broadcast_to(wi, wo.shape))
        all_wo.append(wo)
    return np.concatenate(all_wi), np.concatenate(all_wo)


def coordinates(wi, wo):
    """Half and difference angles [Rusinkiewicz 1998], scaled so that a unit means about as much along each."""
    h = unit(wi + wo)
    theta_h, theta_d = np.arccos(np.clip(h[:, 2], -1, 1)), np.arccos(np.clip((wi * h).sum(-1), -1, 1))
    # cos theta_i - cos theta_o = -2 sin theta_h sin theta_d cos phi_d
    sines = np.maximum(2 * np.sin(theta_h) * np.sin(theta_d), 1e-12)
    phi_d = np.arccos(np.clip(np.abs(wi[:, 2] - wo[:, 2]) / sines, 0, 1))
    return np.stack([3 * np.sqrt(theta_h / (np.pi / 2)), theta_d / (np.pi / 2), phi_d / np.pi * np.sin(theta_d)], -1)


# ---- Truth and figures

class Truth:
    """A BRDF and what figures need of it."""

    def __init__(self, file):
        self.file = file
        self.pairs = drawn_pairs(20000, 7)
        y, x = (1 - (np.arange(SIZE) + 0.5) / SIZE * 2)[:, None], ((np.arange(SIZE) + 0.5) / SIZE * 2 - 1)[None]
        self.inside = x * x + y * y < 1
        n = np.stack(np.broadcast_arrays(x, y, np.sqrt(np.maximum(1 - x * x - y * y, 0))), -1)[self.inside]
        t = unit(np.cross([0.0, 1, 0], n))
        frame = np.stack([t, np.cross(n, t), n], 1)
        lights = [np.array([np.sin(a), 0, np.cos(a)]) for a in np.radians([0, 30, 60])]
        self.wi = np.concatenate([frame @ light for light in lights])
        self.wo = np.concatenate([frame[:, :, 2]] * len(lights))
        self.lit = (self.wi[:, 2] > 0) & (self.wo[:, 2] > 0)
        self.of_pairs, self.of_pixels = self(*self.pairs), self.pixels(self)
        self.exposure = 1 / np.percentile(self.of_pixels, 97)

    def __call__(self, wi, wo):
        both = evaluate(self.file, np.concatenate([wi, wo]), np.concatenate([wo, wi]))
        return (both[:len(wi)] + both[len(wi):]) / 2

    def pixels(self, f):
        values = np.zeros((len(self.wi), 3))
        values[self.lit] = np.nan_to_num(f(self.wi[self.lit], self.wo[self.lit])) * self.wi[self.lit][:, 2:]
        return values

    def figures(self, f):
        def shown(v):
            return np.clip(v * self.exposure, 0, 1) ** (1 / 2.2)

        model, wi = f(*self.pairs), self.pairs[0]
        known = ~np.isnan(model).any(-1)
        truth, model, cosine = self.of_pairs[known], model[known], wi[known][:, 2:]
        square = np.sum((shown(self.of_pixels) - shown(self.pixels(f))) ** 2) / (9 * SIZE * SIZE)
        log = np.abs(np.log((truth + FLOOR) / (model + FLOOR)))
        log_cos = np.abs(np.log1p(truth * cosine) - np.log1p(model * cosine))
        return -10 * np.log10(square), np.expm1(log.mean()), log_cos.mean()


def write_samples(path, wi, wo, f):
    with open(path, "w") as file:
        file.write("# isotropic\nwi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n")
        np.savetxt(file, np.concatenate([wi, wo, f], -1), delimiter=",", fmt="%.8g")


def noisy(f, seed):
    return f * np.exp(NOISE * np.random.default_rng(seed).standard_normal(f.shape) - NOISE**2 / 2)


# ---- What others make of samples: functions of (wi, wo)

def back(logs):
    return np.maximum(np.exp(logs) - FLOOR, 0)


def splines(x, y):
    spline = RBFInterpolator(x, y, neighbors=min(40, len(x)), smoothing=1e-3)
    return lambda wi, wo: back(spline(coordinates(wi, wo)))


def gaussian_process(x, y):
    if len(x) > 5000:
        return None
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel
    some = np.random.default_rng(1).permutation(len(x))[:500]
    kernel = ConstantKernel(1.0) * Matern([0.5, 0.5, 0.5], (1e-2, 1e2), nu=1.5) + WhiteKernel(1e-2, (1e-6, 1))
    mean = y.mean(0)
    found = GaussianProcessRegressor(kernel).fit(x[some], y[some] - mean)
    whole = GaussianProcessRegressor(found.kernel_, optimizer=None).fit(x, y - mean)
    return lambda wi, wo: back(mean + np.concatenate(
        [whole.predict(part) for part in np.array_split(coordinates(wi, wo), 20)]))


def neighbours(x, y):
    tree = cKDTree(x)

    def mean_of_five(wi, wo):
        distance, near = tree.query(coordinates(wi, wo), k=5)
        weight = 1 / np.maximum(distance, 1e-9)
        return back((weight[..., None] * y[near]).sum(1) / weight.sum(1)[:, None])

    return mean_of_five


OTHERS = {"splines": splines, "Gaussian process": gaussian_process, "five neighbours": neighbours}


# ---- The table

def rows_of(truth, wi, wo, seed, folder):
    """(name, figures, bytes, seconds to make, nanoseconds a value of three channels) of every method."""
    samples, model = pathlib.Path(folder, "samples.csv"), pathlib.Path(folder, "model.exr")
    f = noisy(truth(wi, wo), seed)
    write_samples(samples, wi, wo, f)
    seconds = run("fit", samples, "-o", model)[1]
    size = json.loads(run("info", model, "--json")[0])["bytes"]
    yield "fit", truth.figures(lambda i, o: evaluate(model, i, o)), size, seconds
    yield "function", truth.figures(lambda i, o: evaluate(samples, i, o)), samples.stat().st_size, None
    x, y = coordinates(wi, wo), np.log(np.maximum(f, 0) + FLOOR)
    for name, make in OTHERS.items():
        before = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            made = make(x, y)
            if made is None:
                continue
            figures = truth.figures(made)
        yield name, figures, 8 * (x.size + y.size), time.process_time() - before


def share_within(truth, wi, wo, seed, folder):
    samples = pathlib.Path(folder, "samples.csv")
    write_samples(samples, wi, wo, noisy(truth(wi, wo), seed))
    judged = np.minimum(truth.pairs[0][:, 2], truth.pairs[1][:, 2]) > 0.15
    found = evaluate(samples, truth.pairs[0][judged], truth.pairs[1][judged], "--error")
    readings = noisy(truth.of_pairs[judged], seed + 1)
    off = np.abs(np.log((readings + FLOOR) / (found[:, :-1] + FLOOR)))
    known = ~np.isnan(found).any(-1)
    return np.mean((off < 1.645 * np.hypot(found[:, -1:], NOISE))[known])


def gains_of_next(truth, folder):
    """Errors of the function with chosen samples over those with random ones, after each of three rounds of 20."""
    samples, errors = pathlib.Path(folder, "samples.csv"), {}
    for chosen in (True, False):
        wi, wo = drawn_pairs(200, 3)
        f = noisy(truth(wi, wo), 4)
        for step in range(3):
            if chosen:
                write_samples(samples, wi, wo, f)
                text = run("measure", "--next", 20, samples)[0].splitlines()[1:]
                angles = np.radians([[float(x) for x in line.split(",")[:4]] for line in text])
                new = direction(angles[:, 0], angles[:, 1]), direction(angles[:, 2], angles[:, 3])
            else:
                new = drawn_pairs(20, 50 + step)
            wi, wo = np.concatenate([wi, new[0]]), np.concatenate([wo, new[1]])
            f = np.concatenate([f, noisy(truth(*new), 60 + step)])
            write_samples(samples, wi, wo, f)
            errors.setdefault(chosen, []).append(truth.figures(lambda i, o: evaluate(samples, i, o))[1])
    return [a / b for a, b in zip(errors[True], errors[False])]


def table(head, lines):
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *lines]) + "\n"


def main():
    global BURNISH
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--counts", default="300,3000,30000")
    parser.add_argument("--page", help="write the tables to this page of the documents")
    given = parser.parse_args()
    BURNISH = given.burnish
    counts = [int(count) for count in given.counts.split(",")]
    kinds = {f"{count:,}": drawn_pairs(count, 10 + count) for count in counts} | {"8 x 180": incidences()}
    found, within, gains = {}, {}, {}
    for file in given.files:
        truth, name = Truth(file), pathlib.Path(file).stem.removesuffix("_rgb")
        for kind, (wi, wo) in kinds.items():
            with tempfile.TemporaryDirectory() as folder:
                for method, figures, size, seconds in rows_of(truth, wi, wo, 3, folder):
                    found.setdefault((kind, method), []).append((*figures, size, seconds or 0))
                    print(f"{name:24s} {kind:8s} {method:18s} psnr {figures[0]:.2f} relative {figures[1]:.4f} "
                          f"log_cos {figures[2]:.4f} {size} B {seconds or 0:.1f} s", flush=True)
                within.setdefault(name, []).append(share_within(truth, wi, wo, 3, folder))
        with tempfile.TemporaryDirectory() as folder:
            gains[name] = gains_of_next(truth, folder)
        print(f"{name:24s} within 90 %: {np.round(within[name], 3)}; next: {np.round(gains[name], 3)}", flush=True)

    lines = []
    for (kind, method), rows in found.items():
        psnr, relative, log_cos, size, seconds = np.mean(rows, axis=0)
        lines.append([kind, method, f"{psnr:.2f}", f"{relative:.4f}", f"{log_cos:.4f}", f"{size:,.0f}",
                      f"{seconds:.1f}" if seconds else "-"])
    means = table(["samples", "made", "psnr", "relative", "log_cos", "bytes", "s"], lines)
    shares = table(["material", *kinds], [[name, *(f"{share:.3f}" for share in of)] for name, of in within.items()])
    rounds = table(["material", "20 more", "40 more", "60 more"],
                   [[name, *(f"{gain:.2f}" for gain in of)] for name, of in gains.items()])
    print(means, shares, rounds, sep="\n")
    if given.page:
        write_page(given.page, len(given.files), means, shares, rounds)


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    return f"{names[0] if names else platform.machine()} ({platform.machine()})"


def write_page(page, count, means, shares, rounds):
    commit = subprocess.run(["git", "-C", pathlib.Path(__file__).parent, "rev-parse", "--short=8", "HEAD"],
                            capture_output=True, text=True).stdout.strip()
    pathlib.Path(page).write_text(f"""# Scattered samples: how near to the truth

    tests/scattered/score.py build/release/apps/burnish/burnish DATA/rgl/*.bsdf --page docs/results/scattered.md

made this page at commit {commit}, on {os.cpu_count()} cores of {processor()}.
The script says how samples are drawn, what is scored and what the others are. Means over {count} materials.

{means}
`s` is processor time: of `fit` reading, fitting and writing; of the others making and evaluating all that is scored.
`bytes` of `fit` is its model; of `function` the text of the samples; of the others their numbers.

## How far off: the share of other readings within 90 % intervals

{shares}
## Where to measure next: the error after chosen samples over that after random ones

From 200 samples on, three rounds of 20 more, `relative` of the function between samples.

{rounds}""", encoding="utf-8")


if __name__ == "__main__":
    main()
