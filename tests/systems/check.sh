#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check.sh SUITE [--only COMMAND]... makes a bare Debian (bookworm, trixie) by debootstrap and does in it what the
# README says. It installs make and git, then runs `make demo` and `make test` in a clean checkout of HEAD. For each
# command it prints how it ended, its seconds, the megabytes of packages and of the build that it added, and what it
# skipped. COMMAND is demo, test, or units, the unit tests of the optimized build alone. A command that fails and a
# warning of the compiler are faults.
# CXX=g++-13 (or clang++-19, ...) installs and uses that compiler. BURNISH_SYSTEMS=DIR keeps the bare systems and the
# logs. The network serves apt alone: pip and npm are told that there is none. Needs root.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
commands=() suite=
while [ $# -gt 0 ]; do
  case $1 in
    --only)
      case ${2:-} in
        demo | test | units) commands+=("$2") ;;
        *) echo "check.sh: --only: expected demo, test or units, found '${2:-}'" >&2; exit 1 ;;
      esac
      shift 2 ;;
    *)
      [ -z "$suite" ] || { echo "check.sh: expected one suite, found '$suite' and '$1'" >&2; exit 1; }
      suite=$1
      shift ;;
  esac
done
[ -n "$suite" ] || { echo "check.sh: expected a suite (bookworm, trixie), found none" >&2; exit 1; }
[ ${#commands[@]} -gt 0 ] || commands=(demo test)
[ "$(id -u)" = 0 ] || { echo "check.sh: debootstrap and chroot need root" >&2; exit 1; }

work=$(mktemp -d /var/tmp/burnish-system.XXXXXX)  # holds gigabytes, which /tmp may not have
kept=${BURNISH_SYSTEMS:-$work}
root=$work/root
leave() {
  umount "$root/dev/shm" "$root/dev/pts" "$root/proc" 2> /dev/null || true
  if mountpoint -q "$root/proc"; then  # never delete a mounted folder
    echo "check.sh: $root/proc is in use, so $work is left there" >&2
  else
    rm -rf --one-file-system "$work"
  fi
}
trap leave EXIT

mkdir -p "$kept"
log=$kept/$suite${CXX:+-$CXX}
base=$kept/$suite-base
if [ ! -e "$base.made" ]; then
  rm -rf "$base"
  debootstrap --variant=minbase "$suite" "$base" ${DEBIAN_MIRROR:+"$DEBIAN_MIRROR"} > "$log.log" ||
    { tail -20 "$log.log"; exit 1; }
  touch "$base.made"
fi
cp -a "$base" "$root"
mount -t proc proc "$root/proc"
mkdir -p "$root/dev/shm" "$root/dev/pts"
mount -t tmpfs tmpfs "$root/dev/shm"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"

inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    PIP_NO_INDEX=1 npm_config_offline=true ${CXX:+CXX="$CXX"} sh -ec "$1"
}
megabytes() { du -smx "$@" | awk '{sum += $1} END {print sum}'; }

compiler=${CXX:-}
compiler=${compiler/clang++/clang}  # the package of clang++-19 is clang-19
inside "apt-get -qq update && apt-get -qq install --no-install-recommends make git $compiler" > "$log.log" 2>&1 ||
  { tail -20 "$log.log"; exit 1; }
git clone -q "$here" "$root/burnish"

failed=0
for command in "${commands[@]}"; do
  case $command in
    units) line='make -s test-deps && cmake --preset release > /dev/null &&
      cmake --build --preset release --target burnish_tests && GTEST_BRIEF=1 build/release/src/burnish/burnish_tests' ;;
    *) line="make $command" ;;
  esac
  before=$(megabytes "$root") built_before=$(megabytes "$root/burnish") start=$(date +%s) status=0
  inside "cd /burnish; $line" > "$log-$command.log" 2>&1 || status=$?
  seconds=$(($(date +%s) - start))
  built=$(($(megabytes "$root/burnish") - built_before))
  packages=$(($(megabytes "$root") - before - built))
  warnings=$(grep -c ' warning: ' "$log-$command.log" || true)
  compiled_by=$(inside "${CXX:-c++} --version" 2> /dev/null | head -1)
  echo "$suite, $compiled_by: $command: rc $status, $seconds s, $packages MB of packages, $built MB built," \
    "$warnings warnings"
  grep -h -e 'SKIPPED' -e '^Not available here' "$log-$command.log" | sed 's/^/  /' || true
  if [ "$status" != 0 ]; then tail -40 "$log-$command.log"; fi
  if [ "$status" = 0 ] && [ "$warnings" != 0 ]; then grep -m 10 ' warning: ' "$log-$command.log"; fi
  if [ "$status" != 0 ] || [ "$warnings" != 0 ]; then failed=1; fi
done
exit "$failed"
