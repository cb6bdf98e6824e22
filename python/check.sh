#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Python package into build/venv and runs its tests against the command line of the release build. With
# --skip-offline it says so and succeeds where PyPI cannot be reached.
set -eu
cd "$(dirname "$0")/.."
venv=build/venv
pip=("$venv/bin/python" -m pip --disable-pip-version-check --quiet --retries 1 --timeout 20)

[ -x "$venv/bin/pip" ] || python3 -m venv "$venv"
if ! "${pip[@]}" install --only-binary :all: -r python/requirements.txt; then
  [ "${1:-}" = --skip-offline ] || exit 1
  echo "python: SKIPPED: PyPI cannot be reached, so the Python package was neither built nor tested" >&2
  exit 0
fi
# The compiler and flags are those of the release build, since ccache has its objects.
CXX=${CXX:-c++} "${pip[@]}" install --no-build-isolation --no-deps --force-reinstall \
  --config-settings=cmake.define.BURNISH_WERROR="${BURNISH_WERROR:-OFF}" .
# These C++ tests need MaterialX, whose shader OpenPBR is compared with.
tests=build/release/src/burnish/burnish_tests
[ ! -x "$tests" ] || "$tests" --gtest_brief=1 --gtest_filter='GlOpenPbr.*'
# A wheel's notices also name nanobind, as installed here.
status=0
tests/notices/check.py --python "$(echo "$venv"/lib/python3*/site-packages)" || status=$?
[ "$status" = 0 ] || [ "$status" = 77 ] || exit "$status"
tests/options/agree.py build/release/apps/burnish/burnish --python "$venv/bin/python"
exec "$venv/bin/python" -m pytest -q
