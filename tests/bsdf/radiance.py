#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares every part of window systems' files with Radiance: python3 tests/bsdf/radiance.py BURNISH [FILE.xml...]

Needs PyPI's pyradiance (1.3.1), whose bsdf module is Radiance's own evaluator; without it the script says so and ends
with status 0. Without files it makes ten (make_files.py). Of each part in the visible band it checks

- values at 1,000 random pairs of directions, which `burnish eval --part` and Radiance are asked. Values differ by up to
  3e-4, since Radiance takes the part of a BSDF that is the same everywhere out of its tables; more than 1e-3 of a value
  or of 1e-3 is an error;
- the share of light from each incident patch, or from 16 directions of a tree, that the part reflects or transmits. It
  is the sum of burnish's values beside Radiance's hemispherical value (checkBSDF's); more than .5 % is an error.

Then `burnish convert` writes the file anew, with every part, and Radiance is asked for the hemispherical values of both
files; more than 2 % is an error. Radiance's front, z > 0, is the file's back."""
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile

PAIRS, MOST, FLOOR = 1000, 1e-3, 1e-3
MOST_TOTAL, MOST_CONVERTED, TOTAL_FLOOR = 5e-3, 2e-2, 1e-3
REFLECTED, TRANSMITTED = 13, 14  # Radiance's sampling flags: the diffuse part, and the rest of one side
RINGS = {145: ((0, 5, 15, 25, 35, 45, 55, 65, 75, 90), (1, 8, 16, 20, 24, 24, 24, 16, 12)),
         77: ((0, 6.5, 19.5, 32.5, 45.5, 58.5, 71.5, 90), (1, 8, 12, 16, 20, 12, 8)),
         41: ((0, 9, 27, 45, 63, 90), (1, 8, 12, 12, 8))}


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


def radiance_total(bsdf, data, part, theta, phi):
    angle = 180 - math.degrees(theta) if part.endswith("front") else math.degrees(theta)
    return bsdf.direct_hemi(data, angle, math.degrees(phi), TRANSMITTED if part.startswith("trans") else REFLECTED)


def patches(count):
    """Centre and projected solid angle of each patch of a Klems basis."""
    bounds, counts = RINGS[count]
    for low, high, number in zip(bounds, bounds[1:], counts):
        theta = 0 if number == 1 else math.radians((low + high) / 2)
        angle = math.pi * (math.sin(math.radians(high)) ** 2 - math.sin(math.radians(low)) ** 2) / number
        for k in range(number):
            yield (theta, 2 * math.pi * k / number), angle


def squares(side):
    """Centres of the cells of a tree's outgoing square as directions, whose projected solid angles are equal."""
    for i in range(side):
        for j in range(side):
            a, b = 2 * (i + 0.5) / side - 1, 2 * (j + 0.5) / side - 1
            radius, angle = (a, math.pi / 4 * b / a) if abs(a) > abs(b) else (b, math.pi / 2 - math.pi / 4 * a / b)
            x, y = radius * math.cos(angle), radius * math.sin(angle)
            yield (math.asin(math.hypot(x, y)), math.atan2(y, x)), math.pi / side ** 2


def sides_of(file):
    """Incident directions, outgoing directions and their projected solid angles, that sum a file's light exactly; of
    trees up to 6 halvings."""
    text = open(file, encoding="utf-8", errors="replace").read()
    if "TensorTree" in text:
        generator = random.Random(2)
        return [direction(generator) for _ in range(16)], list(squares(64))
    count = 145 if "LBNL/Klems Full</ColumnAngleBasis" in text else 77 if "Half</Column" in text else 41
    outgoing = list(patches(count))
    return [centre for centre, _ in outgoing], outgoing


def worst_total(program, file, bsdf, data, block):
    incident, outgoing = sides_of(file)
    pairs = [(wi, wo) for wi in incident for wo, _ in outgoing]
    values = values_of(program, file, block, pairs)
    worst = 0
    for k, (theta, phi) in enumerate(incident):
        row = values[k * len(outgoing):(k + 1) * len(outgoing)]
        total = sum(f * angle for f, (_, angle) in zip(row, outgoing))
        theirs = radiance_total(bsdf, data, block["part"], theta, phi)
        worst = max(worst, abs(total - theirs) / max(theirs, TOTAL_FLOOR))
    return worst


def worst_conversion(program, file, bsdf, data, blocks, converted):
    """Writes the file anew and compares hemispherical values at its incident directions."""
    target = "tensortree" if "TensorTree" in open(file, encoding="utf-8", errors="replace").read() else "klems"
    burnish(program, "convert", file, converted, "--to", target)
    again = bsdf.load_file(converted)
    worst = 0
    for block in blocks:
        for theta, phi in sides_of(file)[0]:
            one = radiance_total(bsdf, data, block["part"], theta, phi)
            other = radiance_total(bsdf, again, block["part"], theta, phi)
            worst = max(worst, abs(one - other) / max(one, TOTAL_FLOOR))
    return worst


def check(program, file, bsdf, folder):
    blocks = [block for block in json.loads(burnish(program, "info", "--json", file))["parts"]
              if block["band"].lower() in ("visible", "")]
    data = bsdf.load_file(file)
    right = True
    for block in blocks:
        generator = random.Random(1)
        pairs = [(direction(generator), direction(generator)) for _ in range(PAIRS)]
        ours, theirs = values_of(program, file, block, pairs), radiance_values(bsdf, data, block["part"], pairs)
        worst = max(abs(a - b) / max(b, FLOOR) for a, b in zip(ours, theirs))
        total = worst_total(program, file, bsdf, data, block)
        right = right and worst <= MOST and total <= MOST_TOTAL
        print(f"{file}: {block['part']}: values {worst:.2e} apart, mean {sum(theirs) / PAIRS:.4g}, totals {total:.2e}",
              flush=True)
    # Radiance remembers files by their names without folders, so each has a name of its own.
    again = os.path.join(folder, f"again_{os.path.basename(file)}")
    converted = worst_conversion(program, file, bsdf, data, blocks, again)
    print(f"{file}: written anew, totals {converted:.2e} apart", flush=True)
    return right and converted <= MOST_CONVERTED


def main():
    program, files = sys.argv[1], sys.argv[2:]
    try:
        from pyradiance import bsdf
    except ImportError:
        print("pyradiance is not there: nothing is compared (pip install pyradiance==1.3.1)")
        return
    with tempfile.TemporaryDirectory() as folder:
        if not files:
            from make_files import make_files
            files = make_files(os.path.join(folder, "made"))
        if len(files) == 1:
            sys.exit(not check(program, files[0], bsdf, folder))
        # A process each: one that had loaded four files or more did not end.
        sys.exit(max(subprocess.run([sys.executable, __file__, program, file]).returncode for file in files))


if __name__ == "__main__":
    main()
