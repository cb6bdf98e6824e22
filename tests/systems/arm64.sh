#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# arm64.sh [SUITE] makes a bare Debian (default trixie) by debootstrap. In it Debian's cross compiler and libraries of
# arm64 build the command line and the unit tests of a clean checkout of HEAD. qemu-user runs the unit tests of
# evaluation and ten outputs. A table has these outputs beside those of BURNISH, this machine's command line (default
# build/release/apps/burnish/burnish). A failed test and a difference beyond the limits of outputs.py are faults.
# BURNISH_SYSTEMS=DIR keeps the bare system and the logs. JOBS says how many compilers run. Needs root.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
suite=${1:-trixie}
burnish=${BURNISH:-$here/build/release/apps/burnish/burnish}
jobs=${JOBS:-$(nproc)}
# These tests have no fit and no compiler of shaders, which an emulator makes slow.
tests='ByteCount.*:Cbor.*:CompactFile.*:Dds.*:Dual.*:ExactPower*:FactoredBrdf.*:FactoredPlan.*:*/FactoredEvaluatorTest.*'
tests+=':FetchCount.*:FixedPoint*:Formula.*:GaussLegendre.*:Half*:HemisphereMap.*:Interleaved.*:Interval.*:LobeEvaluator.*'
tests+=':LookupExpression.*:Mantissa.*:*PowerSpan*:PowerCosine.*:Projection.*:SamplerExpression.*:SpatialEvaluator.*'
tests+=':Table.*:TableFormat.*:TableGradient.*:TableShape.*:*TabulatedSampler*:Texture.*:TwoPiece*:Warp.*:W8.*'
[ "$(id -u)" = 0 ] || { echo "arm64.sh: debootstrap and chroot need root" >&2; exit 1; }
[ -x "$burnish" ] || { echo "arm64.sh: expected the command line of this machine, found no $burnish" >&2; exit 1; }

work=$(mktemp -d /var/tmp/burnish-arm64.XXXXXX)  # holds gigabytes, which /tmp may not have
kept=${BURNISH_SYSTEMS:-$work}
root=$work/root
leave() {
  umount "$root/proc" 2> /dev/null || true
  if mountpoint -q "$root/proc"; then  # never delete a mounted folder
    echo "arm64.sh: $root/proc is in use, so $work is left there" >&2
  else
    rm -rf --one-file-system "$work"
  fi
}
trap leave EXIT

mkdir -p "$kept"
log=$kept/$suite-arm64
base=$kept/$suite-base
if [ ! -e "$base.made" ]; then
  rm -rf "$base"
  debootstrap --variant=minbase "$suite" "$base" ${DEBIAN_MIRROR:+"$DEBIAN_MIRROR"} > "$log.log" ||
    { tail -20 "$log.log"; exit 1; }
  touch "$base.made"
fi
cp -a "$base" "$root"
mount -t proc proc "$root/proc"

# step NAME 'command' runs a command in the system and prints how it ended.
step() {
  local start status=0
  start=$(date +%s)
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    sh -ec "$2" > "$log-$1.log" 2>&1 || status=$?
  echo "$suite, arm64: $1: rc $status, $(($(date +%s) - start)) s, $(grep -c ' warning: ' "$log-$1.log" || true) warnings"
  [ "$status" = 0 ] || { tail -40 "$log-$1.log"; exit 1; }
}

# Libraries are arm64's; packages that hold headers alone and programs are this machine's.
packages=$(sed '/^#/d' "$here/cmake/debian-packages.txt" | sed -n '/^lib/s/$/:arm64/p' |
  sed -E 's/^(libeigen3-dev|libcli11-dev):arm64$/\1/' | tr '\n' ' ')
step packages "dpkg --add-architecture arm64 && apt-get -qq update && apt-get -qq install --no-install-recommends \
  g++-aarch64-linux-gnu qemu-user cmake ninja-build pkg-config git python3 nlohmann-json3-dev $packages \
  libgtest-dev:arm64 libgmock-dev:arm64"
git clone -q "$here" "$root/burnish"
step build "cd /burnish && cmake --preset release -DCMAKE_TOOLCHAIN_FILE=tests/systems/arm64.cmake &&
  cmake --build --preset release -j $jobs --target burnish_cli burnish_tests"
chroot "$root" aarch64-linux-gnu-readelf -h /burnish/build/release/apps/burnish/burnish | grep -q AArch64 ||
  { echo "arm64.sh: expected a program for AArch64" >&2; exit 1; }
step units "cd /burnish && GTEST_BRIEF=1 qemu-aarch64 build/release/src/burnish/burnish_tests --gtest_filter='$tests'"
tail -2 "$log-units.log"
step outputs "cd /burnish && tests/systems/outputs.py run /outputs qemu-aarch64 /burnish/build/release/apps/burnish/burnish"
"$here/tests/systems/outputs.py" run "$work/outputs" "$burnish" > /dev/null
"$here/tests/systems/outputs.py" compare "$work/outputs" "$root/outputs"
