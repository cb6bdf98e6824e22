#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Opens pages of a site in Chromium, light, dark and as wide as a phone: tests/docs/axe.sh SITE [PICTURES]. Ends with 1
# where axe finds a violation, a page is wider than the screen, or a page asks another server for something. Pictures of
# all pages go to PICTURES. Says so and succeeds where node, npm, Chromium or npm's registry cannot be reached.
set -eu
cd "$(dirname "$0")/../.."
skip() {
  echo "site: SKIPPED: $1, so the site was not opened in a browser" >&2
  exit 0
}
web=build/web
mkdir -p "$web"
for tool in node npm chromium; do
  command -v "$tool" > /dev/null || skip "no $tool"
done
cmp -s tests/web/package-lock.json "$web/package-lock.json" || cp tests/web/package.json tests/web/package-lock.json "$web"
[ "$web/node_modules/.package-lock.json" -nt "$web/package-lock.json" ] ||
  (cd "$web" && timeout 120 npm ci --silent --no-audit --no-fund > /dev/null 2>&1) || skip "npm cannot be reached"
cp tests/docs/axe.mjs "$web"
node "$web/axe.mjs" "$@"
