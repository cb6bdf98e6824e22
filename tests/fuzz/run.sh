#!/usr/bin/env bash
# run.sh [SECONDS]: builds every fuzzer and runs each for SECONDS (60), printing its speed. A find ends the run with
# the input in build/fuzz/finds. Corpora grow in build/fuzz/corpus.
set -euo pipefail
seconds=${1:-60}
cd "$(dirname "$0")/../.."
cmake --preset fuzz > /dev/null
cmake --build --preset fuzz
build=build/fuzz/tests/fuzz
corpus=build/fuzz/corpus
mkdir -p build/fuzz/finds
"$build/make_seeds" "$corpus"
for source in tests/fuzz/*_fuzz.cpp; do
  name=$(basename "$source" _fuzz.cpp)
  mkdir -p "$corpus/$name"
  log=build/fuzz/$name.log
  if ! "$build/${name}_fuzz" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
      -artifact_prefix="build/fuzz/finds/$name-" "$corpus/$name" > "$log" 2>&1; then
    tail -n 40 "$log"
    echo "$name: failed, see $log" >&2
    exit 1
  fi
  awk -v name="$name" '/^stat::number_of_executed_units/ {n = $2} /^stat::average_exec_per_sec/ {s = $2}
    END {printf "%-11s %9d inputs, %7d a second\n", name, n, s}' "$log"
done
