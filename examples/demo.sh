#!/usr/bin/env bash
# demo.sh BURNISH OUT [INPUT]: takes a measurement to two positive textures and shows how good they are. Without INPUT a
# virtual goniometer measures an anisotropic satin first.
set -euo pipefail
burnish=$1 out=$2 input=${3:-}
mkdir -p "$out"
reference=$input
if [ -z "$input" ]; then
  reference=satin
  input=$out/satin.csv
  echo "== A virtual goniometer measures an anisotropic satin: 60,000 scattered samples, 5 % noise"
  "$burnish" measure "$reference" -o "$input" --count 60000 --noise 0.05
fi
echo "== Factoring $input"
"$burnish" fit "$input" -o "$out/model.exr"
echo "== Comparing with $reference"
"$burnish" compare "$reference" "$out/model.exr" -o "$out/report" | tee "$out/figures.txt"
echo
echo "The model:    $out/model.exr (any EXR viewer shows its textures)"
echo "The pictures: $out/report/index.html, $out/report/overview.png"
awk 'NR == 2 {printf "The error:    psnr %s dB, ssim %s, relative %s, in %s bytes\n", $(NF-4), $(NF-3), $(NF-2), $(NF-5)}' \
  "$out/figures.txt"
