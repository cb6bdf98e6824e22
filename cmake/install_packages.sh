#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# install_packages.sh LIST... installs the missing Debian packages among those that the files name, and names them
# first. Where none is missing it needs neither root nor apt. Where it cannot install, it names the missing packages and
# goes on. A machine may have the libraries elsewhere, and CMake names the first that it does not find.
set -euo pipefail
names=$(grep -hv '^#' "$@")
if ! command -v dpkg-query > /dev/null; then
  echo "No dpkg on this system: nothing is installed. docs/dependencies.md says what is needed." >&2
  exit 0
fi
missing=()
for name in $names; do
  dpkg-query -W -f '${Status}' "$name" 2> /dev/null | grep -q 'ok installed' || missing+=("$name")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "Missing: ${missing[*]}" >&2
    echo "There is no sudo: as root, apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 0
  fi
  as_root=(sudo DEBIAN_FRONTEND=noninteractive)
fi
export DEBIAN_FRONTEND=noninteractive
install() { "${as_root[@]}" apt-get install -y -qq --no-install-recommends "$@" > /dev/null; }
echo "Installing by apt-get, with what they need: ${missing[*]}"
"${as_root[@]}" apt-get update -qq || echo "The lists of packages cannot be renewed; trying with those that are there." >&2
install "${missing[@]}" || for name in "${missing[@]}"; do  # skips packages that this system does not have
  install "$name" || echo "Not available here: $name" >&2
done
