#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenEXR's DWAA keeps a FLOAT channel exactly if it is called "lobe", and as lossy half floats if it is called "R".
#
# Version: OpenEXR 3.5.3 (Python package of the Academy Software Foundation).
# Expected: that all channels lose a little, or none. OpenEXR's documentation lists DWAA among the lossy compressions,
#   and FLOAT as a type of 32 bits.
# Seen: of the names tried, R, Y and layer.G go through a cosine transform of halves; A, Z and lobe are stored without
#   a loss. So one table is exact or not by the name of its channel, and in R 100,000 becomes 65,248, near the largest
#   half. A small positive number beside a large one comes back as -0: a positive table is positive no more.
#
#   R        float32: 1e5 -> 65248, largest error of a table up to 2: 0.00491
#   lobe     float32: 1e5 -> 100000, largest error of a table up to 2: 0
#   R, G, B of 1e5, 1e-9, 1 in one file -> 65248, -0, 1
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: OpenEXR==3.5.3 numpy==2.4.6

cat > see.py <<'PY'
import numpy as np
import OpenEXR

def through(channels):
    header = {"compression": OpenEXR.DWAA_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, channels) as file:
        file.write("one.exr")
    with OpenEXR.File("one.exr", separate_channels=True) as file:
        return {name: file.channels()[name].pixels for name in channels}

x = np.exp(-np.linspace(0, 3, 64, dtype=np.float32))
table = (2 * x[:, None] * x[None, :]).astype(np.float32)
error = {}
for name in ("R", "Y", "layer.G", "A", "Z", "lobe"):
    back = through({name: table})[name]
    large = through({name: np.full((32, 32), 1e5, np.float32)})[name]
    error[name] = float(np.abs(back - table).max())
    print(f"{name:8} {back.dtype}: 1e5 -> {large[9, 9]:g}, largest error of a table up to {table.max():g}: "
          f"{error[name]:.3g}")
    assert back.dtype == np.float32
    if name in ("R", "Y", "layer.G"):
        assert 65000 < large[9, 9] < 65505 and error[name] > 1e-3, f"{name} is kept"
    else:
        assert large[9, 9] == np.float32(1e5) and error[name] == 0, f"{name} is changed"
three = through({name: np.full((16, 16), value, np.float32) for name, value in (("R", 1e5), ("G", 1e-9), ("B", 1))})
print(f"R, G, B of 1e5, 1e-9, 1 in one file -> {three['R'][3, 3]:g}, {three['G'][3, 3]:g}, {three['B'][3, 3]:g}")
assert three["G"][3, 3] <= 0, "a small positive number stays positive beside a large one"
PY
venv/bin/python see.py
