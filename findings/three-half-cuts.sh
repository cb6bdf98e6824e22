#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js rounds halves towards zero, so that every float texture gets darker.
#
# Versions: three 0.187.0, @petamoriken/float16 3.9.3 (Math.f16round and Float16Array as ECMAScript 2025 has them).
# Expected: the nearest half, ties to even, as IEEE 754 rounds by default and as ECMAScript's f16round, numpy's
#   float16, OpenEXR's half and F16C do. DataUtils.toHalfFloat says: "Returns a half precision floating point value
#   (FP16) from the given single precision floating point value (FP32)."
# Seen: the bits that do not fit are cut off. Half of all values differ by a last bit, all of them downwards: 0.035 %
#   darker on average, a bias where rounding has none. HDRLoader, and EXRLoader for FLOAT files, use it for the half
#   floats that they give unless told otherwise. Infinity becomes 65504.
#
#   20000 values: 10015 differ from the nearest half, mean relative error -3.46e-4 (nearest: about 0)
#   0.99999 -> 0.99951171875 (nearest 1), Infinity -> 65504
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --prefix . three@0.187.0 @petamoriken/float16@3.9.3 > npm.log

cat > see.mjs <<'JS'
import assert from "node:assert";
import {f16round} from "@petamoriken/float16";
import {DataUtils} from "three";
console.warn = () => {};  // three.js speaks of what is out of range

const theirs = x => DataUtils.fromHalfFloat(DataUtils.toHalfFloat(x));
const count = 20000;
let differ = 0, above = 0, mean = 0, meanNearest = 0;
for (let i = 1; i <= count; ++i) {
  const x = Math.fround(3.7 * i / count);
  differ += theirs(x) !== f16round(x);
  above += theirs(x) > f16round(x);
  mean += (theirs(x) / x - 1) / count;
  meanNearest += (f16round(x) / x - 1) / count;
}
console.log(`${count} values: ${differ} differ from the nearest half, ${above} of them upwards; mean relative error ` +
            `${mean.toExponential(2)} (nearest: ${meanNearest.toExponential(2)})`);
console.log(`0.99999 -> ${theirs(0.99999)} (nearest ${f16round(0.99999)}), Infinity -> ${theirs(Infinity)}`);
assert(differ > 0.4 * count && above === 0 && mean < -3e-4 && Math.abs(meanNearest) < 1e-5, "it rounds otherwise");
assert(theirs(0.99999) < 0.9996 && theirs(Infinity) === 65504, "single values are rounded otherwise");
JS
node see.mjs
