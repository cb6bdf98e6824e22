#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Brings the libraries that benchmarks of the power compare with into build/rivals: the headers of Highway 1.4.0 and, on
# Debian, SLEEF 3.9.0. Run it as tests/rivals/fetch.sh. HIGHWAY_GIT in the environment names another copy of Highway's
# repository. A library that cannot be had is named and left out; the benchmarks then run without it.
set -eu
cd "$(dirname "$0")/../.."
highway=1.4.0 commit=2607d3b5b0113992fe84d3848859eae13b3b52c1
sleef=3.9.0-1
mkdir -p build/rivals
cd build/rivals

fetch_highway() {
  [ ! -e highway/rival/highway.h ] || return 0
  rm -rf highway highway.git
  git -c advice.detachedHead=false clone -q --depth 1 --branch $highway \
    "${HIGHWAY_GIT:-https://github.com/google/highway}" highway.git || return 1
  [ "$(git -C highway.git rev-parse HEAD)" = $commit ] || { echo "Highway $highway: expected commit $commit"; return 1; }
  # Another folder name keeps includes of the system's Highway and of this one apart.
  mkdir -p highway
  cp -r highway.git/hwy highway/rival
  find highway/rival -type f -name '*.h' -exec sed -i 's|\(["<]\)hwy/|\1rival/|' {} +
  rm -rf highway.git
}

# SLEEF comes from Debian's unstable suite, by a list of packages of our own. The system's sources stay as they are.
fetch_sleef() {
  [ ! -e sleef/lib/libsleef.so ] || return 0
  command -v apt-get > /dev/null || return 1
  rm -rf sleef apt
  mkdir -p apt/lists/partial apt/cache/archives/partial sleef/lib
  echo 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian sid main' > apt/sources
  options="-o Dir::Etc::sourcelist=$PWD/apt/sources -o Dir::Etc::sourceparts=- -o Dir::State::lists=$PWD/apt/lists \
    -o Dir::Cache=$PWD/apt/cache -o Acquire::Languages=none -o Acquire::IndexTargets::deb::DEP-11::DefaultEnabled=false"
  apt-get $options update > apt/log 2>&1 || return 1
  (cd apt && apt-get $options download libsleef3=$sleef >> log 2>&1) || return 1
  dpkg-deb -x apt/libsleef3_*.deb apt/files
  cp apt/files/usr/lib/*/libsleef.so.* sleef/lib
  (cd sleef/lib && ln -sf "$(ls libsleef.so.*.*.* | head -1)" libsleef.so)
  rm -rf apt
}

fetch_highway || echo "skipped: Highway $highway cannot be fetched"
fetch_sleef || echo "skipped: SLEEF $sleef cannot be fetched from Debian"
