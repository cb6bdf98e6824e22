#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A BC6H texture, made for values above 1, is cut off at 1 and rounded to bytes by two of three readers.
#
# Versions: Pillow 13.0.0, texture2ddecoder 1.0.6, OpenImageIO 3.2.2.0.
# Expected: half floats, to which BC6H is decoded by the Khronos Data Format Specification and by Direct3D's "BC6H
#   Format".
# Seen: OpenImageIO has the specification's halves to the last bit. Pillow opens the same DDS as mode RGB, and
#   texture2ddecoder gives BGRA bytes: value * 255, cut off at 255, still linear though an RGB picture of bytes is
#   mostly taken for sRGB. Neither warns. A highlight of 77 comes back as 1.
#
#   texel 15: by the specification 0.772949 9.42969 77.1875
#   OpenImageIO       half 0.772949 9.42969 77.1875
#   Pillow            uint8 197 255 255
#   texture2ddecoder  uint8 197 255 255
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: \
  pillow==13.0.0 texture2ddecoder==1.0.6 openimageio==3.2.2.0 numpy==2.4.6

cat > see.py <<'PY'
import struct
import numpy as np
import OpenImageIO
import texture2ddecoder
from PIL import Image

WEIGHTS = (0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64)
FIRST, LAST, STEPS = (400, 500, 560), (480, 600, 700), range(16)

def block():
    """Mode 11 (one subset, ends of 10 bits), each texel another of the sixteen steps."""
    bits, place = 0b00011, 5
    for end in (*FIRST, *LAST):
        bits, place = bits | end << place, place + 10
    for number, step in enumerate(STEPS):
        bits, place = bits | step << place, place + (3 if number == 0 else 4)
    return bits.to_bytes(16, "little")

def half(first, last, step):
    a, b = (((end << 16) + 0x8000) >> 10 for end in (first, last))
    mixed = (a * (64 - WEIGHTS[step]) + b * WEIGHTS[step] + 32) >> 6
    return np.uint16(mixed * 31 >> 6).view(np.float16)

def dds(data):
    head = struct.pack("<7I44x", 124, 0x81007, 4, 4, len(data), 0, 0)  # size, flags, height, width, bytes, depth, mips
    head += struct.pack("<2I4s5I", 32, 4, b"DX10", 0, 0, 0, 0, 0) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    return b"DDS " + head + struct.pack("<5I", 95, 3, 0, 1, 0) + data  # DXGI_FORMAT_BC6H_UF16, 2-D

right = np.array([[half(a, b, step) for a, b in zip(FIRST, LAST)] for step in STEPS])
open("one.dds", "wb").write(dds(block()))
image = OpenImageIO.ImageBuf("one.dds")
exact = image.get_pixels(OpenImageIO.HALF).reshape(16, 3)
pillow = np.asarray(Image.open("one.dds"))
assert pillow.shape == (4, 4, 3)
pillow = pillow.reshape(16, 3)
other = np.frombuffer(texture2ddecoder.decode_bc6(block(), 4, 4), np.uint8).reshape(16, 4)[:, 2::-1]
print("texel 15: by the specification", *(f"{v:g}" for v in right[15]))
print("OpenImageIO      ", image.spec().format, *(f"{v:g}" for v in exact[15]))
print("Pillow           ", pillow.dtype, *pillow[15])
print("texture2ddecoder ", other.dtype, *other[15])
assert str(image.spec().format) == "half" and (exact.astype(np.float16) == right).all(), "OpenImageIO differs"
cut = np.minimum(right.astype(float), 1) * 255
for name, bytes_ in (("Pillow", pillow), ("texture2ddecoder", other)):
    assert bytes_.dtype == np.uint8 and np.abs(bytes_ - cut).max() <= 1, f"{name} decodes otherwise"
PY
venv/bin/python see.py
