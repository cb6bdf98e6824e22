#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sdist.sh FOLDER makes the source of the Python package. pip builds it with the packages that `make deps` installs.
set -euo pipefail
cd "$(dirname "$0")/.."
venv=build/sdist-venv
[ -x "$venv/bin/pip" ] || python3 -m venv "$venv"
"$venv/bin/python" -m pip --disable-pip-version-check --quiet install --only-binary :all: \
  "$(grep -h scikit-build-core python/requirements.txt)"
mkdir -p "$1"
name=$("$venv/bin/python" -c 'import sys; from scikit_build_core.build import build_sdist; print(build_sdist(sys.argv[1]))' \
  "$1" 2> build/sdist.log | tail -1) || { cat build/sdist.log; exit 1; }
ls "$1/$name"
