#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# colour-science's thin films are wrong for metals and absorbing films unless light falls straight on them.
#
# Versions: colour-science 0.4.7, tmm 0.2.0 (the package of the paper that colour's documentation cites).
# Expected: the same reflectances. multilayer_tmm says: "Can be complex for absorbing materials", and
#   thin_film_tmm: "matching the approach used by Byrnes' tmm".
# Seen: at normal incidence both agree. At 60 degrees colour's angle in an absorbing layer is a real number: a slightly
#   absorbing film reflects 4 % less s-polarized light than it should and half of the p-polarized, and a film on or of
#   silver gives nan. Total reflection in a gap of air gives nan too. There is no error; numpy
#   warns of arcsin.
#
#   air | 1.5 + 0.1i, 30 nm | glass   60 deg  colour 0.19300 0.00052  tmm 0.20174 0.00103
#   air | silver, 30 nm | glass       60 deg  colour nan nan          tmm 0.89327 0.66955
#   glass | air, 30 nm | glass        60 deg  colour nan nan          tmm 0.07731 0.14758
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: --no-compile \
  colour-science==0.4.7 tmm==0.2.0 numpy==2.4.6 scipy==1.17.1

cat > see.py <<'PY'
import warnings
import numpy as np
import tmm
warnings.simplefilter("ignore")
from colour.phenomena import multilayer_tmm

stacks = {
    "air | 1.5, 30 nm | air": [1, 1.5, 1],
    "air | 1.5 + 0.1i, 30 nm | glass": [1, 1.5 + 0.1j, 1.5],
    "air | silver, 30 nm | glass": [1, 0.2 + 3.4j, 1.5],
    "air | 2.0, 30 nm | silver": [1, 2.0, 0.2 + 3.4j],
    "glass | air, 30 nm | glass": [1.5, 1, 1.5],
}
off = {}
for name, indices in stacks.items():
    for degrees in (0, 60):
        theirs = multilayer_tmm(indices, [30], 550, degrees)[0].ravel()
        right = np.array([tmm.coh_tmm(p, indices, [np.inf, 30, np.inf], np.radians(degrees), 550)["R"] for p in "sp"])
        off[name, degrees] = float(np.max(np.abs(theirs - right)))
        print(f"{name:32} {degrees:2} deg  colour {theirs[0]:.5f} {theirs[1]:.5f}  tmm {right[0]:.5f} {right[1]:.5f}")

assert all(error < 1e-12 for (_, degrees), error in off.items() if degrees == 0), "normal incidence differs"
assert off["air | 1.5, 30 nm | air", 60] < 1e-12, "a clear film differs"
assert 0.005 < off["air | 1.5 + 0.1i, 30 nm | glass", 60] < 0.02, "an absorbing film is otherwise off"
for name in list(stacks)[2:]:
    assert np.isnan(off[name, 60]), f"{name} has a value at 60 degrees"
PY
venv/bin/python see.py
