#!/usr/bin/env python3
"""Scores fits of scattered samples against the BRDF that the samples were drawn from, beside thin-plate splines.

    tests/scattered/score.py BURNISH FILE.bsdf... [--counts 3000,30000] [--noise 0.05] [-- OPTIONS OF fit]

Each file is measured by `burnish measure`, which draws pairs even in theta_h, theta_d and phi_d, fitted by `burnish fit`
and scored by `burnish compare`. The rival needs numpy and scipy: splines over ln(f + 1e-3) in half and difference
angles, 40 neighbours a value, smoothing 1e-3, sampled into a MERL table, which `burnish compare` scores alike. A table
holds 17 MB. Columns: psnr of three lit spheres in dB, mean relative error, log_cos, bytes, processor seconds."""
import argparse
import json
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile

MERL_SCALES = (1 / 1500, 1.15 / 1500, 1.66 / 1500)


def run(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def figures(burnish, reference, model):
    found = json.loads(run([burnish, "compare", reference, model, "--count", 20000, "--json"])[0])
    figure = found[0]
    return figure["psnr"], figure["relative"], figure["log_cos"]


def coordinates(np, theta_h, theta_d, phi_d):
    phi_d = np.minimum(phi_d % np.pi, np.pi - phi_d % np.pi)
    return np.stack([3 * np.sqrt(theta_h / (np.pi / 2)), theta_d / (np.pi / 2),
                     phi_d / np.pi * np.sin(theta_d)], -1)


def half_difference(np, wi, wo):
    """Angles of the half and the difference vector [Rusinkiewicz 1998]."""
    h = (wi + wo) / np.linalg.norm(wi + wo, axis=-1, keepdims=True)
    sin_h = np.hypot(h[:, 0], h[:, 1])
    cos_phi = np.where(sin_h > 1e-9, h[:, 0] / np.maximum(sin_h, 1e-9), 1)
    sin_phi = np.where(sin_h > 1e-9, h[:, 1] / np.maximum(sin_h, 1e-9), 0)
    x = h[:, 2] * (cos_phi * wi[:, 0] + sin_phi * wi[:, 1]) - sin_h * wi[:, 2]
    y = cos_phi * wi[:, 1] - sin_phi * wi[:, 0]
    return np.arctan2(sin_h, h[:, 2]), np.arccos(np.clip((wi * h).sum(-1), -1, 1)), np.arctan2(y, x)


def spline_table(samples, output):
    """Writes the splines of a CSV of samples as a MERL table; returns its processor time."""
    import numpy as np
    from scipy.interpolate import RBFInterpolator
    before = os.times()
    lines = [line for line in pathlib.Path(samples).read_text().splitlines() if line and line[0] != "#"]
    rows = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    if lines[0].startswith("theta_i"):
        theta_i, phi_i, theta_o, phi_o = np.radians(rows[:, :4]).T
        unit = lambda t, p: np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1)
        wi, wo, values = unit(theta_i, phi_i), unit(theta_o, phi_o), rows[:, 4:]
    else:
        wi, wo, values = rows[:, :3], rows[:, 3:6], rows[:, 6:]
    spline = RBFInterpolator(coordinates(np, *half_difference(np, wi, wo)),
                             np.log(np.maximum(values, 0) + 1e-3), neighbors=40, smoothing=1e-3)
    n_h, n_d, n_p = 90, 90, 180
    theta_h = ((np.arange(n_h) + 0.5) / n_h) ** 2 * np.pi / 2
    theta_d = (np.arange(n_d) + 0.5) / n_d * np.pi / 2
    phi_d = (np.arange(n_p // 2) + 0.5) / n_p * np.pi  # the other half is its mirror image
    table = np.empty((3, n_h, n_d, n_p))
    for i, angle in enumerate(theta_h):
        d, p = np.meshgrid(theta_d, phi_d, indexing="ij")
        f = np.exp(spline(coordinates(np, np.full(d.size, angle), d.ravel(), p.ravel()))) - 1e-3
        half = np.maximum(f, 0).T.reshape(3, n_d, n_p // 2)
        table[:, i] = np.concatenate([half, half[:, :, ::-1]], -1)
    with open(output, "wb") as file:
        file.write(struct.pack("<3i", n_h, n_d, n_p))
        for channel, scale in zip(table, MERL_SCALES):
            file.write((channel / scale).astype("<f8").tobytes())
    after = os.times()
    return after.user + after.system - before.user - before.system


def main():
    arguments, options = sys.argv[1:], []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--counts", default="3000,30000")
    parser.add_argument("--noise", type=float, default=0.05)
    parser.add_argument("--no-rival", action="store_true", help="leave the splines out")
    given = parser.parse_args(arguments)
    sums = {}
    for file in given.files:
        for count in given.counts.split(","):
            with tempfile.TemporaryDirectory() as folder:
                samples, model = pathlib.Path(folder, "samples.csv"), pathlib.Path(folder, "model.exr")
                run([given.burnish, "measure", file, "-o", samples, "--count", count, "--noise", given.noise])
                _, seconds = run([given.burnish, "fit", samples, "-o", model, *options])
                size = json.loads(run([given.burnish, "info", model, "--json"])[0])["bytes"]
                rows = {"fit": (*figures(given.burnish, file, model), size, seconds)}
                if not given.no_rival:
                    table = pathlib.Path(folder, "spline.binary")
                    seconds = spline_table(samples, table)
                    rows["splines"] = (*figures(given.burnish, file, table), table.stat().st_size, seconds)
            for method, row in rows.items():
                sums.setdefault((count, method), []).append(row)
                print("%-28s %7s %-8s psnr %.2f relative %.4f log_cos %.4f %9d B %.1f s"
                      % (pathlib.Path(file).name, count, method, *row), flush=True)
    for (count, method), rows in sums.items():
        mean = [sum(column) / len(rows) for column in zip(*rows)]
        print("MEAN of %-20d %7s %-8s psnr %.2f relative %.4f log_cos %.4f %9d B %.1f s"
              % (len(rows), count, method, *mean))


if __name__ == "__main__":
    main()
