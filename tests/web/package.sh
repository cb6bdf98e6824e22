#!/usr/bin/env bash
# Tests the package that `make studio` built, beside the command line: sizes, then tests/web/package.test.mjs. With
# --if-built it says so and succeeds where there is no package or no node.
set -eu
cd "$(dirname "$0")/../.."
skip() {
  [ "${1:-}" = --if-built ] || exit 1
  echo "studio: SKIPPED: $2" >&2
  exit 0
}
package=build/studio/package
[ -f "$package/burnish.wasm" ] || skip "${1:-}" "no $package, which make studio builds"
command -v node > /dev/null || skip "${1:-}" "no node"

limit=$((2 << 20))
size=$(cat "$package"/*.wasm "$package"/*.js | gzip -9 | wc -c)
echo "studio: the package is $size bytes compressed, of at most $limit"
[ "$size" -le "$limit" ] || exit 1

inputs=build/wasm/test-inputs
mkdir -p "$inputs"
BURNISH_CLI=${BURNISH_CLI:-build/release/apps/burnish/burnish} BURNISH_PACKAGE=$package BURNISH_INPUTS=$inputs \
  node --test --test-reporter=spec tests/web/package.test.mjs
