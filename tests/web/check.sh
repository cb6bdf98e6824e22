#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Opens exports in ktx-parse, three.js, Babylon.js, Chromium and the glTF validator. Compares tangent frames with
# MikkTSpace. Opens the page of a library, and the page in build/studio where `make studio` made it. The tools are
# installed from npm into build/web. With --skip-offline it says so and succeeds where npm, Chromium or the registry
# cannot be reached.
set -eu
cd "$(dirname "$0")/../.."
skip() {
  [ "${1:-}" = --skip-offline ] || exit 1
  echo "web: SKIPPED: $2" >&2
  exit 0
}
burnish=${BURNISH_CLI:-build/release/apps/burnish/burnish}
web=build/web
mkdir -p "$web"
cp tests/web/*.mjs "$web"
cmp -s tests/web/package-lock.json "$web/package-lock.json" || cp tests/web/package.json tests/web/package-lock.json "$web"
for tool in node npm chromium; do
  command -v "$tool" > /dev/null || skip "${1:-}" "no $tool, so exports were not opened elsewhere"
done
[ "$web/node_modules/.package-lock.json" -nt "$web/package-lock.json" ] ||
  (cd "$web" && timeout 120 npm ci --silent --no-audit --no-fund > /dev/null 2>&1) ||
  skip "${1:-}" "npm cannot be reached, so exports were not opened elsewhere"

"$burnish" fit ggx:alpha_x=0.2,alpha_y=0.35,f0=0.9/0.7/0.4 --model pqp --samples 50000 -o "$web/brushed.exr" > /dev/null
"$burnish" export "$web/brushed.exr" --to ktx2 --to cube --to exr --to gltf --to three --to babylon --to glsl --environment sun --mips -o "$web/out" > /dev/null
"$burnish" fit ggx:alpha_x=0.2,alpha_y=0.35,f0=0.9/0.7/0.4 --model "z(theta_h) v(h,d,phi_d)" --table z=24 \
  --table v=12x12x8 --samples 20000 -o "$web/volume.exr" > /dev/null
"$burnish" export "$web/volume.exr" --to three -o "$web/out" > /dev/null
openpbr=openpbr:base_color=0.6/0.3/0.1,specular_ior=1.7,specular_roughness_anisotropy=0.5,coat_weight=0.25
openpbr=$openpbr,coat_roughness=0.1,coat_ior=1.5,fuzz_weight=0.3,thin_film_weight=0.5
"$burnish" export "$openpbr" --to gltf --to three --to babylon -o "$web/out" > /dev/null
sphere() {
  "$burnish" render --mesh sphere --material "$1" --renderer cpu --size 64 --samples 4 --lights 2,3,4:20 \
    -o "$web/out/$2.sphere.exr" > /dev/null
}
sphere "$web/brushed.exr" brushed
sphere "$web/volume.exr" volume
sphere "$openpbr" openpbr
build/release/tests/burnish_input_files "$web/out"
"$burnish" export "$web/out/flat.burnish" --to three --to gltf -o "$web/out" > /dev/null
printf 'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,0,0,1\n' > "$web/normal.csv"
"$burnish" eval "$web/brushed.exr" "$web/normal.csv" -o "$web/value.csv" > /dev/null
NODE_FOLDER=node_modules node "$web/check.mjs" "$web/out" brushed "$(tail -1 "$web/value.csv" | cut -d, -f1)"
node "$web/nodes.mjs" "$web/out" brushed volume openpbr
node "$web/frames.mjs" build/release/tests/burnish_mesh_frames "$web"

# This makes a library's page.
rm -rf "$web/library" && mkdir -p "$web/library"
for alpha in 10 12 14 16 18 20 22 24 26 28 30 32 34 36 38 40; do
  echo "ggx:alpha_x=0.$alpha,alpha_y=0.$alpha,f0=0.9/0.$alpha/0.2"
done > "$web/library.txt"
"$burnish" batch "$web/library.txt" -o "$web/library" --model pqp --samples 2000 > /dev/null
node "$web/catalogue.mjs" "$web/library"

if [ -f build/studio/package/burnish.js ] && [ -f build/studio/index.html ]; then
  build/release/tests/burnish_input_files "$web/studio"
  node "$web/studio.mjs" "$PWD/build/studio" "$burnish" "$web/studio"
else
  echo "web: SKIPPED: no build/studio, so the page was not opened; make studio makes it" >&2
fi
