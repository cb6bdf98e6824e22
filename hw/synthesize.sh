#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Synthesizes units of hw/ with Yosys and nextpnr: hw/synthesize.sh BURNISH SCRATCH [UNIT]..., by default all.
# One line of key=value figures a unit: HX8K and UP5K (placed and routed, seed 1, options' defaults), Xilinx 7, gates,
# standard cells of sky130hd and gf180 (7 tracks, 5 V). Blinn's front end comes last.
# In the environment: YOSYS, the synthesizer of the standard cells (default yosys; "PYTHON hw/pyosys_run.py" takes the
# package pyosys); BURNISH_DATA, whose folder liberty has the cells' files. What is missing prints as -.
set -eu
burnish=$1 scratch=$2
shift 2
mkdir -p "$scratch"
cd "$scratch"
yosys_cells=${YOSYS:-yosys}
for library in sky130_fd_sc_hd__tt_025C_1v80 gf180mcu_fd_sc_mcu7t5v0__tt_025C_5v00; do
  file=${BURNISH_DATA:-/nonexistent}/liberty/$library.lib.gz
  if [ -e "$file" ]; then gunzip -c "$file" > "${library%%_*}.lib"; fi
done

[ $# -gt 0 ] || {
  "$burnish" hw generate --all --vectors 1 --out .
  set -- $(sed -n 's/^  \([a-z0-9_]*\) i_.*/\1/p' bench.sv)
}

or_dash() { awk '{ found = $0 } END { print found == "" ? "-" : found }'; }
frequency() { sed -n 's/.*Max frequency for clock.*: \([0-9.]*\) MHz.*/\1/p' "$1" | tail -1 | or_dash; }
used() { sed -n "s|.*ICESTORM_$2: *\([0-9]*\)/.*|\1|p" "$1" | head -1 | or_dash; }
cells() { awk -v type="$2" '$1 ~ type { sum += $2 } END { print sum + 0 }' "$1"; }

logic() {  # TOP, of what $read reads, for Xilinx 7 and as gates
  yosys -q -p "$read; synth_xilinx -family xc7 -flatten -noiopad -top $1; tee -q -o $1.xilinx stat" > "$1.log" 2>&1
  # tables of a clock stay memories; what is left are gates of one or two inputs and multiplexers
  yosys -q -p "$read; hierarchy -top $1; proc; flatten; opt; memory -nomap; memory_libmap -lib +/ice40/brams.txt;
    memory_map; opt; techmap; opt; abc -g AND,NAND,OR,NOR,XOR,XNOR,MUX; opt_clean; tee -q -o $1.gates stat" > "$1.log" 2>&1
}
logic_figures() {
  echo "luts=$(cells "$1.xilinx" '^LUT') x_ff=$(cells "$1.xilinx" '^FD') x_carry=$(cells "$1.xilinx" '^CARRY4')" \
    "x_bram=$(cells "$1.xilinx" '^RAMB') x_dsp=$(cells "$1.xilinx" '^DSP')" \
    "gates=$(cells "$1.gates" '^[$]_(AND|NAND|OR|NOR|XOR|XNOR|MUX|NOT)_') ff=$(cells "$1.gates" '^[$]_.*DFF')"
}

# The area in um2 of TOP in standard cells, everything flat, tables as logic
area() {  # TOP LIBRARY
  [ -e "$2.lib" ] || { echo -; return; }
  [ -e "$1.$2" ] ||
    $yosys_cells -q -p "$read; synth -flatten -top $1; memory_map; techmap; dfflibmap -liberty $2.lib;
      abc -liberty $2.lib; opt_clean; tee -q -o $1.$2 stat -liberty $2.lib" > "$1.$2.log" 2>&1
  sed -n 's/.*Chip area for .*: *\([0-9]*\)[.].*/\1/p' "$1.$2" | tail -1
}
cell_figures() {
  rm -f "$1.sky130" "$1.gf180mcu"
  echo "sky130=$(area "$1" sky130) gf180=$(area "$1" gf180mcu)"
}

for unit; do
  "$burnish" hw generate --unit "$unit" --vectors 1 --out .
  sources="$(grep -v // "$unit.f" | tr '\n' ' ')"
  width=$(sed -n 's/.*\[\([0-9]*\):0\] *input_i.*/\1/p' "$unit.sv")
  last=$(sed -n 's/.*\[\([0-9]*\):0\] *value_o.*/\1/p' "$unit.sv")
  # a UP5K has 39 pins: the input arrives bit by bit
  cat > "${unit}_pins.sv" <<PINS
module ${unit}_pins (
  input logic clk_i, rst_ni, valid_i, bit_i, ready_i, output logic ready_o, valid_o, output logic [$last:0] value_o
);
  logic [$((width + 10)):0] word_q;
  always_ff @(posedge clk_i) word_q <= {word_q[$((width + 9)):0], bit_i};
  $unit i_unit (
    .clk_i, .rst_ni, .valid_i, .ready_o, .exponent_i(word_q[$((width + 10)):$((width + 1))]),
    .input_i(word_q[$width:0]), .valid_o, .ready_i, .value_o
  );
endmodule
PINS
  read="read_verilog -sv -defer $sources"
  yosys -q -p "$read; synth_ice40 -top $unit -json $unit.json" > "$unit.log" 2>&1
  yosys -q -p "$read ${unit}_pins.sv; synth_ice40 -top ${unit}_pins -json ${unit}_pins.json" > "$unit.log" 2>&1
  if command -v nextpnr-ice40 > /dev/null; then
    nextpnr-ice40 --hx8k --package ct256 --json "$unit.json" --freq 130 --seed 1 --pcf-allow-unconstrained \
      --timing-allow-fail > "$unit.hx" 2>&1
    nextpnr-ice40 --up5k --package sg48 --json "${unit}_pins.json" --freq 65 --seed 1 --pcf-allow-unconstrained \
      --timing-allow-fail > "$unit.up" 2>&1
  else
    : > "$unit.hx"
    : > "$unit.up"
  fi
  logic "$unit"
  echo "unit=$unit lc=$(used "$unit.hx" LC) ebr=$(used "$unit.hx" RAM) hx_mhz=$(frequency "$unit.hx")" \
    "up_mhz=$(frequency "$unit.up") $(logic_figures "$unit") $(cell_figures "$unit")"
done

# Blinn's front end, alone and with the unit it feeds: more multipliers than an iCE40 has
"$burnish" hw generate --blinn --unit exact_8_versine --name blinn_exact --vectors 1 --out .
cp blinn_exact_rsqrt.mem rsqrt.mem
read="read_verilog -sv -defer $(grep -v // blinn_exact.f | tr '\n' ' ')"
for unit in burnish_blinn blinn_exact; do
  logic "$unit"
  echo "vectors=$unit $(logic_figures "$unit") $(cell_figures "$unit")"
done
