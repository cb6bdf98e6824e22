#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Radiance reads a window file that has a Solar band alone as black on both sides, without a word.
#
# Version: pyradiance 1.3.1 (Radiance 6).
# Expected: the reflectance, or a word. Files of Berkeley Lab's WINDOW have a Visible and a Solar band, and Radiance's
#   own wrapBSDF writes either one ("-s spectr").
# Seen: checkBSDF ends with 0 and reports 0.0 % for what is 31.4 % where the word is Visible; the rest of the files is
#   the same. In a scene such a wall would be black. Whoever has a Solar band only may call it Visible, and knows then
#   that its luminance is that of the solar band.
#
#   Visible  Exterior Refl 31.4 31.4 31.4   exit status 0
#   Solar    Exterior Refl  0.0  0.0  0.0   exit status 0
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: pyradiance==1.3.1 numpy==2.4.6

cat > see.py <<'PY'
import os, pathlib, subprocess
import pyradiance

HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<WindowElement xmlns="http://windows.lbl.gov"><WindowElementType>System</WindowElementType><Optical><Layer>
<Material><Name>grey</Name><Manufacturer>none</Manufacturer><Thickness unit="Meter">0.001</Thickness>
<Width unit="Meter">1</Width><Height unit="Meter">1</Height><DeviceType>Other</DeviceType></Material>
<DataDefinition><IncidentDataStructure>Columns</IncidentDataStructure></DataDefinition>
<WavelengthData><LayerNumber>System</LayerNumber><Wavelength unit="Integral">BAND</Wavelength><WavelengthDataBlock>
<WavelengthDataDirection>Reflection Front</WavelengthDataDirection>
<ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis><RowAngleBasis>LBNL/Klems Full</RowAngleBasis>
<ScatteringDataType>BRDF</ScatteringDataType><ScatteringData>"""
TAIL = "</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>\n"

home = pathlib.Path(pyradiance.__file__).parent
environment = {**os.environ, "RAYPATH": f".:{home / 'lib'}"}
seen = {}
for band in ("Visible", "Solar"):
    pathlib.Path("one.xml").write_text(HEAD.replace("BAND", band) + "0.1, " * (145 * 145 - 1) + "0.1" + TAIL)
    run = subprocess.run([home / "bin" / "checkBSDF", "one.xml"], env=environment, capture_output=True, text=True)
    line = next(line for line in run.stdout.splitlines() if line.startswith("Exterior Refl"))
    seen[band] = run.returncode, run.stderr.strip(), line.split()[2:5]
    print(f"{band:8} {line.split(chr(9))[0]} {' '.join(seen[band][2])}   exit status {run.returncode} {run.stderr}")
assert seen["Visible"] == (0, "", ["31.4"] * 3), "the visible band is read otherwise"
assert seen["Solar"] == (0, "", ["0.0"] * 3), "the solar band is no longer black, or something is said"
PY
venv/bin/python see.py
