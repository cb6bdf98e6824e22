// c^exponent as 2^-(exponent u), u = -log2 c, within one unit of the last place of value_o for every exponent
// and every input (0.82 at most; docs/results/hardware.md).
//   exponent_i  U10.0, 1 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 2 to OutBits + 12
//   value_o     c^exponent (2^OutBits - 1): full at c = 1, 0 at c = 0, never falling as c rises
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 3 to 20.
// The parameters below Depth and the tables' images belong together: `burnish hw generate --method exact`.
module burnish_exact #(
  parameter int CosineBits   = 15,
  parameter int OutBits      = 8,
  parameter bit Versine      = 0,
  parameter int Depth        = 3,
  parameter int LogBits      = 19,
  parameter int LogIndexBits = 7,
  parameter int LogWordBits  = 16,
  parameter int LogSlopeBits = 0,
  parameter int ExpIndexBits = 4,
  parameter     LogFile      = "log.mem",
  parameter     ExpFile      = "exp.mem"
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                valid_i,
  output logic                ready_o,
  input  logic [9:0]          exponent_i,
  input  logic [CosineBits:0] input_i,
  output logic                valid_o,
  input  logic                ready_i,
  output logic [OutBits-1:0]  value_o
);
  localparam int OctaveBits   = OutBits > 8 ? 4 : 3;
  localparam int FractionBits = OutBits + 2;  // of exponent * u
  // Where the pipeline is cut as Depth grows beyond input, table and output.
  localparam bit CutPower    = Depth > 3;
  localparam bit CutLog      = Depth > 4;
  localparam bit CutMantissa = Depth > 5;
  localparam bit CutSum2     = Depth > 6;
  localparam bit CutFall     = Depth > 7;
  localparam bit CutSum1     = Depth > 8;
  localparam bit CutVersine  = Depth > 9;
  localparam bit CutLogFirst = Depth > 10;
  localparam bit CutWord     = Depth > 11;
  localparam bit CutOctave   = Depth > 12;
  localparam bit CutDigits   = Depth > 13;
  localparam bit CutShift    = Depth > 14;
  localparam bit CutTable    = Depth > 15;
  localparam bit CutCarry    = Depth > 16;
  localparam bit CutLogHalf  = Depth > 17;
  localparam bit CutFallHalf = Depth > 18;
  localparam bit CutExpTable = Depth > 19;
  localparam int LogCuts     = (CutLogFirst ? 1 : 0) | (CutLog ? 2 : 0) | (CutTable ? 4 : 0)
                             | (CutLogHalf ? 8 : 0);
  localparam int ProductCuts = (CutDigits ? 1 : 0) | (CutSum1 ? 2 : 0) | (CutSum2 ? 4 : 0) | (CutPower ? 8 : 0)
                             | (CutCarry ? 16 : 0);
  localparam int ExpCuts     = (CutWord ? 1 : 0) | (CutFall ? 2 : 0) | (CutMantissa ? 4 : 0) | (CutShift ? 8 : 0)
                             | (CutFallHalf ? 16 : 0) | (CutExpTable ? 32 : 0);

  logic                    advance;
  logic [CosineBits:0]     cosine;
  logic [CosineBits-1:0]   versine, versine_v;
  logic [9:0]              exponent_q, exponent_v, exponent_o, exponent_t, exponent_w, exponent_l, exponent_m;
  logic [9:0]              exponent_u;
  logic [OctaveBits-1:0]   octave;
  logic [OctaveBits:0]     scale_t, scale_w, scale_l, scale_m, scale_u;  // tiny, octave
  logic [CosineBits-2:0]   rest;
  logic [LogBits-1:0]      log;
  logic [FractionBits+3:0] power;
  logic                    overflow, beyond, tiny, zero, unused;
  logic [OutBits-1:0]      value;

  burnish_flow #(.Depth(Depth)) i_flow (
    .clk_i, .rst_ni, .valid_i, .ready_o, .valid_o, .ready_i, .advance_o(advance)
  );

  burnish_cut #(.Width(10)) i_exponent (
    .clk_i, .advance_i(advance), .data_i(exponent_i), .data_o(exponent_q)
  );
  // v = 1 reads as the largest v below it, whose output is 0 as well
  burnish_input #(.CosineBits(CosineBits), .Versine(Versine)) i_input (
    .clk_i, .advance_i(advance), .input_i, .cosine_o(cosine), .versine_o(versine), .zero_o(zero)
  );
  assign unused = ^{cosine, zero};
  burnish_cut #(.Width(CosineBits + 10), .Enable(CutVersine)) i_versine (
    .clk_i, .advance_i(advance), .data_i({exponent_q, versine}), .data_o({exponent_v, versine_v})
  );
  burnish_octave #(.Bits(CosineBits), .OctaveBits(OctaveBits), .Cut(CutOctave)) i_octave (
    .clk_i, .advance_i(advance), .versine_i(versine_v), .octave_o(octave), .rest_o(rest), .tiny_o(tiny)
  );
  burnish_cut #(.Width(10), .Enable(CutOctave)) i_half (
    .clk_i, .advance_i(advance), .data_i(exponent_v), .data_o(exponent_o)
  );
  burnish_log2 #(
    .RestBits(CosineBits - 1), .LogBits(LogBits), .IndexBits(LogIndexBits), .WordBits(LogWordBits),
    .SlopeBits(LogSlopeBits), .Cuts(LogCuts), .File(LogFile)
  ) i_log (
    .clk_i, .advance_i(advance), .rest_i(rest), .log_o(log)
  );
  burnish_cut #(.Width(OctaveBits + 11)) i_table (
    .clk_i, .advance_i(advance), .data_i({exponent_o, tiny, octave}), .data_o({exponent_t, scale_t})
  );
  burnish_cut #(.Width(OctaveBits + 11), .Enable(CutTable)) i_word (
    .clk_i, .advance_i(advance), .data_i({exponent_t, scale_t}), .data_o({exponent_w, scale_w})
  );
  burnish_cut #(.Width(OctaveBits + 11), .Enable(CutLogHalf)) i_log_half (
    .clk_i, .advance_i(advance), .data_i({exponent_w, scale_w}), .data_o({exponent_l, scale_l})
  );
  burnish_cut #(.Width(OctaveBits + 11), .Enable(CutLogFirst)) i_first (
    .clk_i, .advance_i(advance), .data_i({exponent_l, scale_l}), .data_o({exponent_m, scale_m})
  );
  burnish_cut #(.Width(OctaveBits + 11), .Enable(CutLog)) i_sum (
    .clk_i, .advance_i(advance), .data_i({exponent_m, scale_m}), .data_o({exponent_u, scale_u})
  );
  burnish_product #(
    .ABits(10), .BBits(LogBits + OctaveBits), .Drop(LogBits - FractionBits), .OutBits(FractionBits + 4), .Saturate(1),
    .Cuts(ProductCuts)
  ) i_product (
    .clk_i, .advance_i(advance), .a_i(exponent_u), .b_i({scale_u[OctaveBits-1:0], log}), .product_o(power),
    .overflow_o(beyond)
  );
  logic [5:0] tiny_u;
  assign tiny_u[0] = scale_u[OctaveBits];
  for (genvar i = 0; i < 5; i++) begin : gen_tiny
    burnish_cut #(.Width(1), .Enable(ProductCuts[i])) i_tiny (
      .clk_i, .advance_i(advance), .data_i(tiny_u[i]), .data_o(tiny_u[i+1])
    );
  end
  assign overflow = beyond | tiny_u[5];
  burnish_exp2 #(.OutBits(OutBits), .IndexBits(ExpIndexBits), .Cuts(ExpCuts), .File(ExpFile)) i_exp (
    .clk_i, .advance_i(advance), .power_i(power), .overflow_i(overflow), .value_o(value)
  );
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
endmodule
