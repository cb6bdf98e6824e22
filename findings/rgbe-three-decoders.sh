#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# One Radiance picture (.hdr) has three linear values, depending on who reads it.
#
# Versions: pyradiance 1.3.1 (Radiance 6), opencv-python-headless 5.0.0.93, OpenImageIO 3.2.2.0, three 0.187.0.
# Expected: one value. Radiance's "File Formats" (filefmts.pdf) owns the format: four bytes, three mantissas and a
#   common exponent, as in "Real Pixels" of Graphics Gems II, whose decoder adds half a step to each mantissa.
# Seen: Radiance's pvalue has (m + 0.5) / 256 * 2^(e - 128). OpenCV and OpenImageIO have m / 256, which is 0.2 % (m
#   of 255) to 0.4 % (128) less, for a pixel's largest channel. three.js has m / 255, 0.39 % more than theirs whatever m
#   is. So an environment lights a surface a little brighter in one program than in another.
#
#   bytes 128 64 255, exponent 129
#   pvalue       1.004 0.5039 1.996
#   OpenCV       1.0 0.5 1.9921875
#   OpenImageIO  1.0 0.5 1.9921875
#   three.js     1.003921627998352 0.501960813999176 2
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: \
  pyradiance==1.3.1 opencv-python-headless==5.0.0.93 openimageio==3.2.2.0 numpy==2.4.6
npm install --silent --no-audit --no-fund --prefix . three@0.187.0 > npm.log

cat > three.mjs <<'JS'
import {readFileSync} from "node:fs";
import {FloatType} from "three";
import {HDRLoader} from "three/examples/jsm/loaders/HDRLoader.js";
const bytes = readFileSync("one.hdr");
const loader = new HDRLoader();
loader.setDataType(FloatType);
const picture = loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
console.log(JSON.stringify(Array.from(picture.data.slice(0, 3))));
JS

cat > see.py <<'PY'
import json, pathlib, subprocess
import cv2, OpenImageIO, pyradiance

mantissas, exponent = (128, 64, 255), 129
open("one.hdr", "wb").write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + bytes([*mantissas, exponent]))

pvalue = pathlib.Path(pyradiance.__file__).parent / "bin" / "pvalue"
line = subprocess.run([pvalue, "-h", "-H", "-o", "one.hdr"], check=True, capture_output=True, text=True).stdout
seen = {
    "pvalue": [float(word) for word in line.split()[2:]],
    "OpenCV": cv2.imread("one.hdr", cv2.IMREAD_UNCHANGED)[0, 0, ::-1].tolist(),
    "OpenImageIO": OpenImageIO.ImageBuf("one.hdr").get_pixels()[0, 0].tolist(),
    "three.js": json.loads(subprocess.run(["node", "three.mjs"], check=True, capture_output=True, text=True).stdout),
}
print("bytes", *mantissas, "exponent", exponent)
for name, values in seen.items():
    print(f"{name:12}", *values)

def near(values, decode):
    return all(abs(v - decode(m) * 2.0 ** (exponent - 128)) < 6e-4 for v, m in zip(values, mantissas, strict=True))

assert near(seen["pvalue"], lambda m: (m + 0.5) / 256), "Radiance decodes otherwise"
assert near(seen["OpenCV"], lambda m: m / 256) and seen["OpenCV"] == seen["OpenImageIO"], "OpenCV or OpenImageIO"
assert near(seen["three.js"], lambda m: m / 255) and seen["three.js"][2] == 2, "three.js decodes otherwise"
PY
venv/bin/python see.py
