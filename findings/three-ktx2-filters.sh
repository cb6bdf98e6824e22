#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js's loader of KTX2 filters a texture by its format: half floats by nearest texel, blocks linearly, BC6H not.
#
# Versions: three 0.187.0, ktx-parse 2.0.0 (which writes the files).
# Expected: one filter for all; KTX 2.0 says nothing of samplers, and the page of KTX2Loader in three.js' documentation
#   nothing of filters. BC6H_UFLOAT_BLOCK is a format of Vulkan that KTX2 holds, and three.js has
#   RGB_BPTC_UNSIGNED_Format for it.
# Seen: RGBA16F, 2-D or 3-D, and RGBA8 come with NearestFilter, BC5 and BC7 with LinearFilter. A table that was tried
#   as BC7 and is shipped as half floats shows steps until magFilter and minFilter are set. BC6H, the only block of
#   high dynamic range, is refused: "Unsupported vkFormat: 143".
#
#   R16G16B16A16_SFLOAT 2-D  DataTexture        mag NearestFilter  min NearestFilter
#   BC7_UNORM_BLOCK 2-D      CompressedTexture  mag LinearFilter   min LinearFilter
#   BC6H_UFLOAT_BLOCK 2-D    THREE.KTX2Loader: Unsupported vkFormat: 143
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --prefix . three@0.187.0 ktx-parse@2.0.0 > npm.log

cat > see.mjs <<'JS'
import assert from "node:assert";
import * as ktx from "ktx-parse";
import * as THREE from "three";
import {KTX2Loader} from "three/examples/jsm/loaders/KTX2Loader.js";

const nameOf = value => Object.keys(THREE).find(name => name.endsWith("Filter") && THREE[name] === value);

async function filters(format, bytes, depth = 0) {
  const container = ktx.createDefaultContainer();
  Object.assign(container, {vkFormat: ktx[`VK_FORMAT_${format}`], pixelWidth: 4, pixelHeight: 4, pixelDepth: depth,
                            levelCount: 1});
  container.levels = [{levelData: new Uint8Array(bytes), uncompressedByteLength: bytes}];
  const file = ktx.write(container);
  const loader = new KTX2Loader();
  loader.workerConfig = {};  // what detectSupport finds matters to Basis textures alone
  const told = `${format} ${depth ? "3-D" : "2-D"}`.padEnd(24);
  try {
    const texture = await loader._createTexture(file.buffer.slice(file.byteOffset, file.byteOffset + file.length));
    console.log(told, texture.constructor.name.padEnd(18), "mag", nameOf(texture.magFilter), " min",
                nameOf(texture.minFilter));
    return nameOf(texture.magFilter);
  } catch (error) {
    console.log(told, error.message);
    return "refused";
  }
}
assert.equal(await filters("R16G16B16A16_SFLOAT", 128), "NearestFilter");
assert.equal(await filters("R16G16B16A16_SFLOAT", 512, 4), "NearestFilter");
assert.equal(await filters("R8G8B8A8_UNORM", 64), "NearestFilter");
assert.equal(await filters("BC5_UNORM_BLOCK", 16), "LinearFilter");
assert.equal(await filters("BC7_UNORM_BLOCK", 16), "LinearFilter");
assert.equal(await filters("BC6H_UFLOAT_BLOCK", 16), "refused");
JS
node see.mjs
