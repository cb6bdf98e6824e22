#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/results/hardware.md: hw/report.py BURNISH SYNTHESIS SPHERE, the latter two the output of hw/synthesize.sh and of
`hw/verify.sh sphere`. The text is hw/hardware.md.in; what stands in it as @name@ is measured here, at the commit that
BURNISH_COMMIT says."""
import json
import os
import pathlib
import subprocess
import sys

burnish, synthesis, sphere = sys.argv[1:]

EXACT = ["exact_8", "exact_8_pipelined", "exact_8_versine", "exact_10", "exact_12", "quadratics_8", "quadratics_12"]


def measured(*arguments):
    answer = subprocess.run([burnish, "hw", "error", "--json", *arguments], check=True, capture_output=True, text=True)
    return json.loads(answer.stdout)


def error(unit):
    more = ["--input-step", "31"] if unit.endswith("versine") else ["--first", "5"] if unit.startswith("w8") else []
    return measured("--unit", unit, *more)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


figures, vectors = {}, {}
for line in pathlib.Path(synthesis).read_text().splitlines():
    values = dict(word.split("=") for word in line.split())
    if "unit" in values:
        figures[values["unit"]] = values
    else:
        vectors[values["vectors"]] = values
errors = {unit: error(unit) for unit in figures}
depths = {}
for unit in figures:
    module = subprocess.run([burnish, "hw", "generate", "--unit", unit, "--vectors", "1", "--out", synthesis + ".units"],
                            check=True) and pathlib.Path(synthesis + ".units", unit + ".sv").read_text()
    depths[unit] = module.split(" clocks.")[0].split()[-1]

blocks = table(
    ["block", "clocks", "HX8K LC / EBR / MHz", "UP5K MHz", "Xilinx 7 LUT / FF / BRAM / DSP", "gates / FF",
     "sky130hd, um2", "gf180 7t, um2", "error, LSB of 8 bits"],
    [[f"`{unit}`", depths[unit], f"{f['lc']} / {f['ebr']} / {f['hx_mhz']}", f["up_mhz"], f"{f['luts']} / {f['x_ff']} / {f['x_bram']} / {f['x_dsp']}",
      f"{f['gates']} / {f['ff']}", f["sky130"], f["gf180"], f"{errors[unit]['max_error_lsb']:.2f}" + ("*" if unit.endswith(("_10", "_12")) else "")]
     for unit, f in figures.items()])
blinn = table(
    ["from vectors", "Xilinx 7 LUT / FF / BRAM / DSP", "gates / FF", "sky130hd, um2", "gf180 7t, um2"],
    [[f"`{name}`", f"{f['luts']} / {f['x_ff']} / {f['x_bram']} / {f['x_dsp']}", f"{f['gates']} / {f['ff']}", f["sky130"],
      f["gf180"]] for name, f in vectors.items()])
widths = table(
    ["unit", "vectors", "largest error, LSB", "correctly rounded", "answers that fall as c rises", "tables, words x bits"],
    [[f"`{unit}`", f"{e['vectors']:,}", f"{e['max_error_lsb']:.3f}", f"{100 * e['correctly_rounded']:.2f} %", e["falls"],
      " + ".join(f"{t['words']} x {t['width']}" for t in e["tables"])] for unit, e in errors.items() if unit in EXACT])


def rounded(bits, kind, exponent):
    return measured("--cos-bits", str(bits), "--input", kind, "--rounded-input", "--last", str(exponent))["max_error_lsb"]


inputs = table(
    ["input", *(f"e = {e}" for e in (10, 100, 500, 1000))],
    [[name, *(f"{rounded(bits, kind, e):.2f}" for e in (10, 100, 500, 1000))]
     for name, bits, kind in (("c, 15 bits", 15, "cosine"), ("v, 15 bits", 15, "versine"), ("c, 20 bits", 20, "cosine"),
                              ("v, 20 bits", 20, "versine"))])
differences = table(["unit", "largest difference, levels"],
                    [line.split() for line in pathlib.Path(sphere).read_text().splitlines() if line])

text = pathlib.Path(__file__).with_name("hardware.md.in").read_text()
for name, value in {"blocks": blocks, "blinn": blinn, "widths": widths, "inputs": inputs, "differences": differences,
                    "commit": os.environ.get("BURNISH_COMMIT", "unknown")}.items():
    text = text.replace(f"@{name}@", value)
sys.stdout.write(text)
