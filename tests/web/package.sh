#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests the package of `make studio` beside the command line: sizes, then tests/web/package.test.mjs.
set -eu
cd "$(dirname "$0")/../.."
missing() {
  echo "studio: $1" >&2
  exit 1
}
package=build/studio/package
[ -f "$package/burnish.wasm" ] || missing "no $package, which make studio builds"
command -v node > /dev/null || missing "no node"

limit=$((2 << 20))
size=$(cat "$package"/*.wasm "$package"/*.js | gzip -9 | wc -c)
echo "studio: the package is $size bytes compressed, of at most $limit"
[ "$size" -le "$limit" ] || exit 1

inputs=build/wasm/test-inputs
mkdir -p "$inputs"
BURNISH_CLI=${BURNISH_CLI:-build/release/apps/burnish/burnish} BURNISH_PACKAGE=$package BURNISH_INPUTS=$inputs \
  node --test --test-reporter=spec tests/web/package.test.mjs
