#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ml_dtypes rounds doubles to bfloat16 twice, and so to the wrong neighbour; numpy's float16 is rounded once.
#
# Versions: ml_dtypes 0.6.0, numpy 2.4.6.
# Expected: the nearest number, as numpy's own astype(float16) gives of doubles, and as IEEE 754 has for conversions.
# Seen: a double goes to float first. 1 + 2^-8 + 2^-30 is above the middle between 1 and 1 + 2^-7; as a float it is the
#   middle, and the tie goes to even, 1. So tables that are fitted in double and stored in bfloat16 differ in the last
#   bit from a conversion of the doubles. The same kind of number goes the right way in float16.
#
#   bfloat16 of 1 + 2^-8 + 2^-30:  1.0       (nearest 1.0078125)
#   float16  of 1 + 2^-11 + 2^-40: 1.0009765625 (nearest 1.0009765625)
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: ml-dtypes==0.6.0 numpy==2.4.6

cat > see.py <<'PY'
import ml_dtypes
import numpy as np

def nearest(value, bits):
    """Of values in [1, 2), with so many bits behind the point; exact, since value - 1 scales by a power of two."""
    return 1 + round((value - 1) * 2**bits) / 2**bits

for name, kind, bits, value in (("bfloat16", ml_dtypes.bfloat16, 7, 1 + 2**-8 + 2**-30),
                                ("float16", np.float16, 10, 1 + 2**-11 + 2**-40)):
    for sign in (1, -1):
        got = float(np.array([sign * value]).astype(kind)[0])
        print(f"{name:8} of {sign * value:.12f}: {got} (nearest {sign * nearest(value, bits)})")
        assert (got == sign * nearest(value, bits)) == (kind is np.float16), f"{name} is rounded otherwise"
PY
venv/bin/python see.py
