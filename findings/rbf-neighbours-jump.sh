#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# scipy's RBFInterpolator with neighbors= jumps between a goniometer's samples, by 2 % of a BRDF's value.
#
# Versions: scipy 1.17.1, numpy 2.4.6.
# Expected: a continuous function, as sums of smooth kernels are. scipy's reference says of neighbors that a value is
#   computed "using only this many nearest data points", and nothing of what that does to the function.
# Seen: where the set of nearest samples changes, the value jumps. A lobe is sampled every 5 degrees of theta and 15 of
#   phi and interpolated in its logarithm, as BRDFs are, with the default kernel: 16 neighbours jump, all samples
#   together do not. A picture shows edges about highlights, and differences across a jump are no gradient.
#
#   16 neighbours: largest step over 6.7e-06 of the unit disk is 2.2367 % of the value, the median 0.0064 %
#   all samples:   largest step over 6.7e-06 of the unit disk is 0.0098 % of the value, the median 0.0064 %
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: --no-compile scipy==1.17.1 numpy==2.4.6

cat > see.py <<'PY'
import numpy as np
from scipy.interpolate import RBFInterpolator

theta, phi = (a.ravel() for a in np.radians(np.meshgrid(np.arange(5, 81, 5.0), np.arange(0, 360, 15.0))))
samples = np.column_stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi)])
mirror = np.array([np.sin(np.radians(30)), 0])
brdf = 0.05 + np.exp(-np.sum((samples - mirror) ** 2, axis=1) / np.radians(8) ** 2)

at = np.linspace(0.3, 0.7, 60001)
path = np.column_stack([at, np.full(at.size, 0.03)])
largest = {}
for name, neighbours in (("16 neighbours", 16), ("all samples", None)):
    values = np.exp(RBFInterpolator(samples, np.log(brdf), neighbors=neighbours)(path))
    steps = np.abs(np.diff(values)) / values[:-1]
    largest[name] = steps.max()
    print(f"{name + ':':14} largest step over {at[1] - at[0]:.1e} of the unit disk is {100 * steps.max():.4f} % of the "
          f"value, the median {100 * np.median(steps):.4f} %")
assert largest["16 neighbours"] > 0.01, "neighbours do not jump any more"
assert largest["all samples"] < 0.001, "all samples jump"
PY
venv/bin/python see.py
