#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh [SECONDS] builds every fuzzer and runs each for SECONDS (60) of the processor, as many at a time as there are
# cores. It prints the number of inputs of each. A find ends the run and leaves its input in build/fuzz/finds. Corpora
# grow in build/fuzz/corpus. BUILT=DIR runs the programs of a folder instead of building them.
set -euo pipefail
seconds=${1:-60}
cd "$(dirname "$0")/../.."
if [ -z "${BUILT:-}" ]; then
  cmake --preset fuzz > /dev/null
  cmake --build --preset fuzz -j "${JOBS:-$(nproc)}"
fi
export build=${BUILT:-build/fuzz/tests/fuzz} corpus=build/fuzz/corpus seconds
mkdir -p build/fuzz/finds
"$build/make_seeds" "$corpus"

# libFuzzer knows the clock alone. A busy machine takes time from a fuzzer, which gets it back in further runs.
fuzz() {
  local name=$1 log=build/fuzz/$1.log used=0 inputs=0 TIMEFORMAT='%U %S'
  mkdir -p "$corpus/$name"
  while [ "$used" -lt "$seconds" ]; do
    if ! { time "$build/${name}_fuzz" -max_total_time=$((seconds - used)) -timeout=10 -rss_limit_mb=2048 \
        -print_final_stats=1 -artifact_prefix="build/fuzz/finds/$name-" "$corpus/$name" > "$log" 2>&1; } 2> "$log.time"; then
      tail -n 40 "$log"
      echo "$name: failed, see $log" >&2
      return 255  # ends xargs
    fi
    inputs=$((inputs + $(awk '/^stat::number_of_executed_units/ {print $2}' "$log")))
    used=$((used + 1 + $(awk '{printf "%d", $1 + $2}' "$log.time")))
  done
  printf '%-12s %10d inputs in %4d s of the processor\n' "$name" "$inputs" "$used"
}
export -f fuzz

basename -a tests/fuzz/*_fuzz.cpp | sed 's/_fuzz\.cpp$//' | xargs -P "${JOBS:-$(nproc)}" -I{} bash -euo pipefail -c 'fuzz {}'
