#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check.sh FOLDER installs each package of FOLDER where nothing else of burnish is: a .deb, a .whl, the Python package's
# source, a .tgz of npm. It runs the demo there, or a first fit where there is no command line, and prints what each
# takes. A missing package is a fault. Each package must be below its limit.
# The .deb goes into a Debian made by debootstrap, which needs root; BURNISH_ROOT=DIR keeps it for the next time. The
# wheel goes into an empty virtual environment without a compiler in the path, where its tests must pass too. The .tgz
# goes into an empty folder.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(cd "$1" && pwd)
work=$(mktemp -d)
root=${BURNISH_ROOT:-$work/debian}
leave() { umount "$root/proc" 2> /dev/null || true; rm -rf "$work"; }
trap leave EXIT
size() { echo "$(($(stat -c %s "$1") / 1024)) KiB  $(basename "$1")"; }
# at_most FILE MIB fails where the file is larger.
at_most() {
  [ "$(stat -c %s "$1")" -le "$(($2 << 20))" ] || { echo "$1: larger than $2 MiB" >&2; exit 1; }
}
seconds() { echo "$(($(date +%s) - $1)) s"; }

check_deb() {
  echo "== $(size "$1")"
  at_most "$1" 15
  lintian --allow-root --fail-on error,warning "$1"
  if [ ! -x "$root/bin/sh" ]; then
    debootstrap --variant=minbase bookworm "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" > "$work/log" ||
      { tail -20 "$work/log"; exit 1; }
  fi
  mount -t proc proc "$root/proc"
  cp "$1" "$here/examples/demo.sh" "$root/tmp/"
  chroot "$root" apt-get -qq purge burnish libburnish-dev > /dev/null 2>&1 || true
  local start
  start=$(date +%s)
  chroot "$root" sh -c "export DEBIAN_FRONTEND=noninteractive; apt-get -qq update &&
    apt-get -qq install --no-install-recommends '/tmp/$(basename "$1")'" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
  echo "installed in $(seconds "$start")"
  if [ -z "${BURNISH_ROOT:-}" ] && chroot "$root" sh -c 'command -v c++ || command -v cc'; then
    echo "a compiler came with the package" >&2
    exit 1
  fi
  chroot "$root" burnish --version
  start=$(date +%s)
  chroot "$root" bash -e /tmp/demo.sh burnish /tmp/demo | tail -3
  echo "demo in $(seconds "$start")"
  test -s "$root/tmp/demo/knot.png"
  # These are the other files that a system looks for.
  test -s "$root/usr/share/man/man1/burnish-fit.1.gz" || chroot "$root" dpkg -L burnish | grep -q man1/burnish-fit.1.gz
  bash -n "$root/usr/share/bash-completion/completions/burnish"
  test -s "$root/usr/share/zsh/vendor-completions/_burnish"
  chroot "$root" bash -c 'source /usr/share/bash-completion/completions/burnish
    COMP_WORDS=(burnish fit --los) COMP_CWORD=2; _burnish; [ "${COMPREPLY[*]}" = --loss ]'
  chroot "$root" burnish help formats | grep -q OpenMATERIAL
  check_library
  umount "$root/proc"
}

# The packages that libburnish-dev suggests must be enough for a program against the library, found by pkg-config and by
# CMake.
check_library() {
  local development=("$folder"/libburnish-dev_*.deb)
  echo "== $(size "${development[0]}")"
  at_most "${development[0]}" 15
  lintian --allow-root --fail-on error,warning "${development[0]}"
  cp "${development[0]}" "$root/tmp/"
  chroot "$root" dpkg -i "/tmp/${development[0]##*/}" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
  local suggested=$(chroot "$root" dpkg-query -W -f '${Suggests}' libburnish-dev | tr -d ,)
  chroot "$root" sh -c "export DEBIAN_FRONTEND=noninteractive
    apt-get -qq install --no-install-recommends g++ make cmake pkgconf $suggested" > "$work/log" 2>&1 ||
    { tail -20 "$work/log"; exit 1; }
  rm -rf "$root/tmp/consumer" && cp -r "$here/tests/install" "$root/tmp/consumer"
  sed -n '/^```cpp$/,/^```$/{/^```/d;p}' "$here/README.md" > "$root/tmp/consumer/readme_example.inc"
  chroot "$root" sh -ec 'cd /tmp/consumer
    burnish measure ggx:alpha_x=0.3,alpha_y=0.3 -o paint.csv --count 2000 > /dev/null
    mv paint.csv paint.binary
    c++ -std=c++20 -I. consumer.cpp $(pkg-config --cflags --libs burnish) -o by_pkg_config && ./by_pkg_config
    cmake -B built -DEXAMPLE_FOLDER=/tmp/consumer > /dev/null && cmake --build built > /dev/null && built/consumer'
  echo "a program is built against its library, by pkg-config and by CMake"
}

# version PYTHON prints the version, such as 311, or nothing where that Python does not run.
version() { "$1" -c 'import sys; print("%d%d" % sys.version_info[:2])' 2> /dev/null || true; }

# Tests a wheel with the Pythons here that it is for (PYTHONS names more): its own one, or with a stable ABI all newer
# ones.
check_wheel() {
  echo "== $(size "$1")"
  at_most "$1" 12
  local python made tried=
  made=$(basename "$1" | sed 's/.*-cp\(3[0-9]*\)-.*/\1/')
  for python in $(printf '%s\n' python3 python3.{10..20} ${PYTHONS:-} | awk '!seen[$0]++'); do
    local own=$(version "$python")
    [ -n "$own" ] && [[ " $tried " != *" $own "* ]] || continue
    case $1 in
      *-abi3-*) [ "$own" -ge "$made" ] || continue ;;
      *) [ "$own" = "$made" ] || continue ;;
    esac
    tried="$tried $own"
    check_wheel_with "$1" "$python"
  done
  [ -n "$tried" ] || echo "NOT TRIED: no Python that this wheel is for is here; PYTHONS=... names one" >&2
}

# check_wheel_with WHEEL PYTHON tests a wheel with one Python.
check_wheel_with() {
  local start
  start=$(date +%s)
  rm -rf "$work/venv" "$work/empty"
  "$2" -m venv "$work/venv"
  mkdir "$work/empty"
  (cd "$work/empty" && export PATH="$work/venv/bin" && pip --disable-pip-version-check -q install --only-binary :all: "$1" &&
    python "$here/tests/release/first_fit.py")
  local taken=$(seconds "$start")
  echo "$("$2" --version): from pip install to the first fit: $taken"
  [ "${taken% s}" -le 30 ] || { echo "more than 30 s" >&2; exit 1; }
  # The package's own tests skip those of Mitsuba, MaterialX and USD where these are missing.
  (cd "$work/empty" && export PATH="$work/venv/bin" BURNISH_CLI="$here/build/release/apps/burnish/burnish" &&
    pip --disable-pip-version-check -q install --only-binary :all: pytest && ! command -v c++ &&
    python -m pytest -q -p no:cacheprovider --rootdir "$here" "$here/python/tests")
}

# pip alone builds the source, as on a machine with the packages of `make deps`.
check_sdist() {
  echo "== $(size "$1")"
  at_most "$1" 3
  local start
  start=$(date +%s)
  python3 -m venv "$work/from-source"
  (cd "$work" && "$work/from-source/bin/pip" --disable-pip-version-check -q install "$1" &&
    "$work/from-source/bin/python" "$here/tests/release/first_fit.py")
  echo "from pip install of the source to the first fit: $(seconds "$start")"
}

check_npm() {
  echo "== $(size "$1")"
  local start
  start=$(date +%s)
  mkdir "$work/npm"
  cp "$here/tests/release/first_fit.mjs" "$work/npm/"
  (cd "$work/npm" && echo '{"private": true}' > package.json &&
    npm install --offline --no-audit --no-fund --loglevel=error "$1" > /dev/null && node first_fit.mjs)
  echo "from npm install to the first fit: $(seconds "$start")"
}

check() {
  [ -e "$2" ] || { echo "$folder: no ${2##*/}" >&2; exit 1; }
  "check_$1" "$2"
}
for package in "$folder"/burnish_*.deb; do check deb "$package"; done
for package in "$folder"/*.whl; do check wheel "$package"; done
for package in "$folder"/burnish-[0-9]*[0-9].tar.gz; do check sdist "$package"; done
for package in "$folder"/*.tgz; do check npm "$package"; done
