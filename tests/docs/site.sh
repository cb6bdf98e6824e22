#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the site into build/site and tests its search: tests/docs/site.sh [--skip-offline] [--no-notebooks]. Its
# packages are installed from PyPI into build/venv-site. With --skip-offline it says so and succeeds where PyPI cannot
# be reached. Without node it does not test the search, and says so too.
set -eu
cd "$(dirname "$0")/../.."
venv=build/venv-site offline=fail options=()
for word in "$@"; do
  case $word in --skip-offline) offline=skip ;; *) options+=("$word") ;; esac
done
if [ ! "$venv/installed" -nt docs/site/requirements.txt ]; then
  [ -x "$venv/bin/pip" ] || python3 -m venv "$venv"
  if ! "$venv/bin/python" -m pip --disable-pip-version-check --quiet --retries 1 --timeout 20 install \
    --only-binary :all: -r docs/site/requirements.txt; then
    [ "$offline" = skip ] || exit 1
    echo "site: SKIPPED: PyPI cannot be reached, so the site was not built" >&2
    exit 0
  fi
  touch "$venv/installed"
fi
"$venv/bin/python" docs/make_site.py "${options[@]}"
if command -v node > /dev/null; then
  node tests/docs/search.mjs build/site
else
  echo "site: SKIPPED: no node, so nobody asked its search" >&2
fi
