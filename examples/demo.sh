#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo.sh BURNISH OUT [INPUT] takes a measurement to two positive textures and prints their accuracy. Without INPUT, a
# virtual goniometer first measures an anisotropic satin.
set -euo pipefail
burnish=$1 out=$2 input=${3:-}
mkdir -p "$out"
reference=$input
if [ -z "$input" ]; then
  reference=satin:f0=0.85/0.35/0.16,kd=0.06/0.01/0.03
  input=$out/satin.csv
  echo "== A virtual goniometer measures a copper satin, anisotropic: 60,000 scattered samples, 5 % noise"
  "$burnish" measure "$reference" -o "$input" --count 60000 --noise 0.05
fi
echo "== Factoring $input"
"$burnish" fit "$input" -o "$out/model.exr"
echo "== Rendering it"
"$burnish" render --renderer cpu --mesh torus-knot --material "$out/model.exr" --size 480 -o "$out/knot.png"
echo "== Comparing with $reference"
"$burnish" compare "$reference" "$out/model.exr" -o "$out/report"
echo
echo "The model:    $out/model.exr (any EXR viewer shows its textures)"
echo "The pictures: $out/knot.png, $out/report/index.html, $out/report/overview.png"
# Reads the first model's members of the report, by name.
awk -F '[ ":,]+' '!($2 in value) {value[$2] = $3}
  END {printf "The error:    psnr %.2f dB, ssim %.4f, relative %.4f, in %d bytes\n", value["psnr"], value["ssim"],
         value["relative"], value["bytes"]}' "$out/report/report.json"
