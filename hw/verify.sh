#!/bin/sh
# Checks of the hardware: hw/verify.sh STEP BURNISH LIBRARY SCRATCH
#   lint        verilator --lint-only -Wall on every unit
#   simulate    Verilator against the C++ model, 20,000 vectors a unit with random pauses
#   icarus      the generated test benches
#   prove       yosys-smtbmc and z3: handshake and order of the exact 8-bit unit, for 24 exponents
#   exhaustive  Verilator with every exponent and every input of every unit, and the proofs for every exponent
#               (UNITS in the environment: only these)
#   sphere      a sphere shaded by simulated units: hw/verify.sh sphere BURNISH LIBRARY SCRATCH PROGRAM PNG
# BURNISH is the command line, LIBRARY libburnish.a, SCRATCH a folder to work in. 77: a tool is missing.
set -eu
step=$1 burnish=$2 library=$3 scratch=$4
hw=$(cd "$(dirname "$0")" && pwd)
jobs=${JOBS:-2}

need() {
  for tool; do
    command -v "$tool" > /dev/null || { echo "skipped: $tool is not installed (make deps installs it)"; exit 77; }
  done
}

generate() {  # VECTORS of each unit into a fresh folder, where everything below runs
  rm -rf "$scratch"
  mkdir -p "$scratch"
  cd "$scratch"
  "$burnish" hw generate --all --vectors "$1" --out .
  "$burnish" hw generate --blinn --unit exact_8_versine --name blinn_exact --vectors "$1" --out .
  units=$(sed -n 's/^  \([a-z0-9_]*\) i_.*/\1/p' bench.sv)
}

build_bench() {  # of the module bench in bench.sv
  verilator --cc --exe --build -j "$jobs" -O3 --x-assign fast --x-initial fast --top-module bench --prefix Vbench \
    -Mdir bench_build -y . bench.sv "$hw/tb/bench.cpp" \
    -CFLAGS "-std=c++20 -O2 -I$hw/../src" -LDFLAGS "$library -lfmt" > build.log 2>&1 ||
    { cat build.log; exit 1; }
}

build_one() {  # bench of UNIT alone
  rm -rf bench_build
  "$burnish" hw generate --unit "$1" --vectors 1 --out .
  build_bench
}

prove() {  # MODULE STEPS bounded|induction LOGIC [PARAMETER VALUE]...; LOGIC: words or gates, what z3 is given
  module=$1 steps=$2 mode=$3 logic=$4
  shift 4
  parameters=
  while [ $# -gt 0 ]; do parameters="$parameters -set $1 $2"; shift 2; done
  formal=
  [ ! -e "$hw/formal/$module.sv" ] || formal=$hw/formal/$module.sv
  gates=
  [ "$logic" = words ] || gates="techmap; opt; abc -g AND,XOR,MUX;"
  yosys -q -p "read_verilog -sv -formal -defer $hw/rtl/*.sv $formal; ${parameters:+chparam$parameters $module;}
    prep -top $module -flatten; async2sync; memory -nordff; memory_map; opt -full; $gates dffunmap; opt_clean;
    write_smt2 $module.smt2" > yosys.log 2>&1 || { cat yosys.log; exit 1; }
  case $mode in
    bounded) set -- -t "$steps" ;;
    induction) set -- -i -t "$steps" ;;
  esac
  yosys-smtbmc -s z3 --unroll "$@" "$module.smt2" > smt.log 2>&1 || { cat smt.log; echo "FAILED: $module"; exit 1; }
  echo "proved: $module, $mode $steps$parameters"
}

prove_all() {  # of the exact 8-bit unit; EXPONENTS, the first of each eight
  "$burnish" hw generate --unit exact_8 --name exact --out .
  mv exact_log.mem log.mem; mv exact_exp.mem exp.mem
  for depth in 3 15; do
    prove burnish_flow 1 induction words Depth $depth
    prove burnish_flow 3 bounded words Depth $depth
  done
  prove tokens 9 bounded words
  if [ $step = exhaustive ]; then
    prove ends 5 bounded words
    prove order_log 3 bounded words
  fi
  prove order_exp 1 bounded gates
  for first; do prove order_product 1 bounded words First "$first" Count 8; done
}

case $step in
  lint)
    need verilator
    generate 1
    for unit in $units blinn_exact; do verilator --lint-only -Wall --top-module "$unit" -f "$unit.f"; done
    echo "PASS no warning" ;;
  simulate)
    need verilator
    generate 1
    build_bench
    bench_build/Vbench sample 20000 $units ;;
  icarus)
    need iverilog vvp
    generate 400
    for unit in $units blinn_exact; do
      iverilog -g2012 -o "$unit.vvp" -f "$unit.f" "${unit}_tb.sv"
      answer=$(vvp -n "$unit.vvp")
      echo "$unit: $answer"
      case $answer in PASS*) ;; *) exit 1 ;; esac
    done ;;
  prove)
    need yosys yosys-smtbmc z3
    generate 1
    prove_all 1 505 1016 ;;
  exhaustive)
    need verilator yosys yosys-smtbmc z3
    generate 1
    for unit in ${UNITS:-$units}; do
      build_one "$unit"
      echo "$unit: $(bench_build/Vbench all "$unit")"
    done
    "$burnish" hw generate --blinn --unit exact_8_versine --name blinn_exact --vectors 1000000 --out .
    verilator --binary -O3 --top-module blinn_exact_tb -Mdir blinn_build -Wno-fatal -f blinn_exact.f blinn_exact_tb.sv \
      > build.log 2>&1 || { cat build.log; exit 1; }
    echo "blinn_exact: $(blinn_build/Vblinn_exact_tb | grep -E 'PASS|FAIL')"
    prove_all $(seq 1 8 1009) 1016 ;;
  sphere)
    need verilator
    program=$5 png=$6
    mkdir -p "$scratch"
    cd "$scratch"
    set --
    for unit in exact_8_pipelined paper_literal paper; do
      build_one "$unit"
      "$program" questions "$unit" | bench_build/Vbench stream "$unit" > "$unit.answers"
      set -- "$@" "$unit=$unit.answers"
    done
    "$program" picture "$png" "$@" ;;
  *) sed -n '2,11s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
