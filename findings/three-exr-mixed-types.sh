#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js reads an OpenEXR file whose colours have two types as numbers of 1e16, without a word.
#
# Versions: three 0.187.0, OpenEXR 3.5.3 (which writes the file, and reads it back as it was).
# Expected: the values, or an error: "OpenEXR File Layout" gives each channel a pixel type of its own.
# Seen: EXRLoader takes one type for all colour channels. With R and G of FLOAT and B of HALF, blue is 2.4e16 in the
#   place of 212, and other texels have the values of neighbours; asked for half floats, it is 65504. A depth Z of FLOAT
#   beside colours of HALF does no harm. Whoever saves memory on one colour has to save it on all.
#
#   first texel of row 3: 12 112 212 by OpenEXR, 12 112 23693719664328704 by three.js
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: OpenEXR==3.5.3 numpy==2.4.6
npm install --silent --no-audit --no-fund --prefix . three@0.187.0 > npm.log

cat > make.py <<'PY'
import numpy as np
import OpenEXR

a = np.arange(16, dtype=np.float32).reshape(4, 4)
header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
for name, blue in (("same", a + 200), ("mixed", (a + 200).astype(np.float16))):
    with OpenEXR.File(header, {"R": a, "G": a + 100, "B": blue}) as file:
        file.write(f"{name}.exr")
    with OpenEXR.File(f"{name}.exr", separate_channels=True) as file:
        back = [file.channels()[channel].pixels for channel in "RGB"]
    assert all((pixels == a + 100 * i).all() for i, pixels in enumerate(back)), "OpenEXR itself"
    print(f"{name:5} by OpenEXR: ", *(f"{pixels[3, 0]:g}" for pixels in back), [str(p.dtype) for p in back])
PY
venv/bin/python make.py

cat > see.mjs <<'JS'
import assert from "node:assert";
import {readFileSync} from "node:fs";
import {FloatType} from "three";
import {EXRLoader} from "three/examples/jsm/loaders/EXRLoader.js";

function texels(name) {
  const bytes = readFileSync(`${name}.exr`);
  const loader = new EXRLoader();
  loader.setDataType(FloatType);
  return loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)).data;  // last row first
}
const same = texels("same"), mixed = texels("mixed");
console.log("same  by three.js:", ...same.slice(0, 3));
console.log("mixed by three.js:", ...mixed.slice(0, 3));
assert.deepEqual([...same.slice(0, 3)], [12, 112, 212]);
assert(mixed[0] === 12 && mixed[1] === 112 && mixed[2] > 1e15, "mixed types are read otherwise");
JS
node see.mjs
