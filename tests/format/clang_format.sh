#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang_format.sh (-i | --check) FILE... formats files, or checks their format, by clang-format 14. Other versions
# differ in dozens of places. A system's own version 14 serves; otherwise it comes from PyPI, into build/format. Without
# either, -i fails, and --check says SKIPPED and succeeds.
set -euo pipefail
cd "$(dirname "$0")/../.."
version=14.0.6
mode=$1
shift
venv=build/format
formatter=
for candidate in "$venv/bin/clang-format" clang-format-14 clang-format; do
  if "$candidate" --version 2> /dev/null | grep -q "version ${version%.*}\."; then
    formatter=$candidate
    break
  fi
done
if [ -z "$formatter" ]; then
  echo "Installing clang-format $version from PyPI into $venv"
  if { [ -x "$venv/bin/pip" ] || python3 -m venv "$venv"; } &&
    "$venv/bin/python" -m pip --disable-pip-version-check --quiet --retries 1 --timeout 20 \
      install --only-binary :all: "clang-format==$version" 2> /dev/null; then
    formatter=$venv/bin/clang-format
  else
    why="no clang-format ${version%.*} here, and PyPI cannot be reached or python3-venv is missing"
    [ "$mode" = --check ] || { echo "format: $why" >&2; exit 1; }
    echo "format: SKIPPED: $why" >&2
    exit 0
  fi
fi
case $mode in
  -i) exec "$formatter" -i "$@" ;;
  --check) exec "$formatter" --dry-run -Werror "$@" ;;
  *) echo "clang_format.sh: expected -i or --check, found '$mode'" >&2; exit 1 ;;
esac
