#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# versions.sh [FOLDER] checks that all files that state a version state the same one, and so do the names of FOLDER's
# artefacts.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
version=$(sed -n 's/^project(burnish VERSION \([0-9.]*\).*/\1/p' "$here/CMakeLists.txt")
npm=$(sed -n 's/^  "version": "\(.*\)",$/\1/p' "$here/web/package/package.json")
[ "$npm" = "$version" ] || { echo "web/package/package.json: expected version $version, found $npm" >&2; exit 1; }
[ $# = 1 ] || exit 0
for kind in "burnish_$version[-_]*.deb" "libburnish-dev_$version[-_]*.deb" "burnish-$version-*.whl" \
    "burnish-$version.tar.gz" "burnish-$version.tgz" "burnish-$version-source.tar.gz" "burnish-studio-$version.tar.gz"; do
  compgen -G "$1/$kind" > /dev/null || { echo "$1: expected $kind, found none" >&2; exit 1; }
done
for file in "$1"/*; do
  [[ $(basename "$file") = *"$version"* ]] || { echo "$file: expected a name with $version" >&2; exit 1; }
done
