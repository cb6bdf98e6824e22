#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# pywincalc cannot find the patch of two fifths of the outgoing directions, in any Klems basis.
#
# Version: pywincalc 3.3.1 (Windows-CalcEngine of Berkeley Lab).
# Expected: each direction of the hemisphere lies in one patch: a Klems basis is a tiling, and the lambdas of its own
#   patches (lambda_vector) sum to pi. Incident directions behave so.
# Seen: the outgoing basis counts azimuths from about 180 degrees on and does not wrap at 360: get_nearest_beam_index
#   raises "Could not find nearest beam index" for azimuths from 0 to where the first patch of the ring begins. The
#   same direction with 360 degrees added is found, for every one of them.
#
#   basis    patches  incident not found  outgoing not found  of those, not with phi + 360 either
#   QUARTER       41      0 of  1144         469 of  1144       0
#   HALF          77      0 of  1144         480 of  1144       0
#   FULL         145      0 of  1144         516 of  1144       0
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: pywincalc==3.3.1 numpy==2.4.6

cat > see.py <<'PY'
import pywincalc

def found(directions, theta, phi):
    try:
        directions.get_nearest_beam_index(theta, phi)
        return True
    except RuntimeError as error:
        assert "nearest beam index" in str(error), error
        return False

grid = [(theta, phi) for theta in range(2, 90, 4) for phi in range(0, 360, 7)]
print("basis    patches  incident not found  outgoing not found  of those, not with phi + 360 either")
for name in ("QUARTER", "HALF", "FULL"):
    hemisphere = pywincalc.BSDFHemisphere.create(getattr(pywincalc.BSDFBasisType, name))
    incident = hemisphere.get_directions(pywincalc.BSDFDirection.Incoming)
    outgoing = hemisphere.get_directions(pywincalc.BSDFDirection.Outgoing)
    lost_in = [at for at in grid if not found(incident, *at)]
    lost_out = [at for at in grid if not found(outgoing, *at)]
    lost_turned = [(theta, phi) for theta, phi in lost_out if not found(outgoing, theta, phi + 360)]
    print(f"{name:8} {len(outgoing.lambda_vector()):7}  {len(lost_in):5} of {len(grid):5}  "
          f"{len(lost_out):10} of {len(grid):5}  {len(lost_turned):6}")
    print(f"         largest azimuth that is lost: {max(phi for _, phi in lost_out)} degrees")
    assert not lost_in and not lost_turned, "incident directions are lost, or turned ones"
    assert len(lost_out) > len(grid) / 3 and max(phi for _, phi in lost_out) < 180, "outgoing ones are found"
PY
venv/bin/python see.py
