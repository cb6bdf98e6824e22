#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js shows an OpenEXR file of X, Y and Z as the grey of its Y.
#
# Versions: three 0.187.0, OpenEXR 3.5.3 (which writes the file).
# Expected: three channels or an error, as EXRLoader gives one for R and G alone ("file contains unsupported data
#   channels"). "OpenEXR Technical Introduction" knows Y alone as a grey picture and Y, RY, BY as luminance and chroma.
# Seen: tristimulus values (or the components of a normal map or of a direction, where they are called X, Y, Z) come
#   back as a grey RGBA texture: Y three times, X and Z gone, without a warning. Call the channels R, G, B.
#
#   X Y Z of a texel: 12 112 212    three.js: 112 112 112 1
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
for names in ("XYZ", "RGB", "RG"):
    with OpenEXR.File(header, {name: a + 100 * i for i, name in enumerate(names)}) as file:
        file.write(f"{names}.exr")
PY
venv/bin/python make.py

cat > see.mjs <<'JS'
import assert from "node:assert";
import {readFileSync} from "node:fs";
import {FloatType} from "three";
import {EXRLoader} from "three/examples/jsm/loaders/EXRLoader.js";
let warned = 0;
console.warn = () => { ++warned; };

function first(name) {
  const bytes = readFileSync(`${name}.exr`);
  const loader = new EXRLoader();
  loader.setDataType(FloatType);
  return [...loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)).data.slice(0, 4)];
}
console.log("R, G, B of 12, 112, 212:", ...first("RGB"));
console.log("X, Y, Z of 12, 112, 212:", ...first("XYZ"), `(${warned} warnings)`);
assert.deepEqual(first("RGB"), [12, 112, 212, 1]);
assert.deepEqual(first("XYZ"), [112, 112, 112, 1]);
assert.throws(() => first("RG"), error => { console.log("R, G:", error.message ?? error); return true; });
assert.equal(warned, 0);
JS
node see.mjs
