#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares every part of window systems' files with Radiance: python3 tests/bsdf/radiance.py BURNISH FILE.xml...

Needs PyPI's pyradiance (1.3.1), whose bsdf.query is Radiance's own evaluator; without it the script says so and ends
with status 0. Of each part in the visible band it draws 1,000 pairs of directions, and asks `burnish eval --part` and
Radiance. Radiance's front, z > 0, is the file's back. Its values differ by up to 3e-4, since it takes the part of a
BSDF that is the same everywhere out of its tables; more than 1e-3 of a value or of 1e-3 is an error."""
import csv
import json
import math
import random
import subprocess
import sys

PAIRS, MOST, FLOOR = 1000, 1e-3, 1e-3


def burnish(*arguments, stdin=None):
    done = subprocess.run(arguments, input=stdin, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return done.stdout


def direction(generator):
    theta, phi = math.acos(math.sqrt(generator.random())), 2 * math.pi * generator.random()
    return theta, phi


def vector(theta, phi):
    return math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)


def values_of(program, file, block, pairs):
    """What burnish says: wi above the surface, wo of a transmission below it."""
    below = block["part"].startswith("transmission")
    lines = ["wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"]
    for (theta_i, phi_i), (theta_o, phi_o) in pairs:
        wi, wo = vector(theta_i, phi_i), vector(math.pi - theta_o if below else theta_o, phi_o)
        lines.append(",".join(repr(x) for x in wi + wo))
    band = ["--band", block["band"]] if block["band"] else []
    text = burnish(program, "eval", file, "-", "--part", block["part"], *band, stdin="\n".join(lines) + "\n")
    return [float(row["value"]) for row in csv.DictReader(text.splitlines())]


def radiance_values(bsdf, data, part, pairs):
    light_below = part.endswith("front")
    view_below = light_below != part.startswith("transmission")
    values = []
    for (theta_i, phi_i), (theta_o, phi_o) in pairs:
        angles = (math.pi - theta_i if light_below else theta_i, phi_i,
                  math.pi - theta_o if view_below else theta_o, phi_o)
        values.append(float(bsdf.query(data, *map(math.degrees, angles))[1]))
    return values


def main():
    program, files = sys.argv[1], sys.argv[2:]
    try:
        from pyradiance import bsdf
    except ImportError:
        print("pyradiance is not there: nothing is compared (pip install pyradiance==1.3.1)")
        return
    failed = False
    for file in files:
        blocks = json.loads(burnish(program, "info", "--json", file))["parts"]
        data = bsdf.load_file(file)
        for block in blocks:
            if block["band"].lower() not in ("visible", ""):
                continue
            generator = random.Random(1)
            pairs = [(direction(generator), direction(generator)) for _ in range(PAIRS)]
            ours, theirs = values_of(program, file, block, pairs), radiance_values(bsdf, data, block["part"], pairs)
            worst = max(abs(a - b) / max(b, FLOOR) for a, b in zip(ours, theirs))
            failed = failed or not worst <= MOST
            print(f"{file}: {block['part']}: {PAIRS} pairs, at most {worst:.2e} apart, mean {sum(theirs) / PAIRS:.4g}")
    sys.exit(failed)


if __name__ == "__main__":
    main()
