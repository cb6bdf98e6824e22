// c^exponent as 2^-(exponent u), u = -log2 c, as special function units of graphics processors form it: the logarithm
// of the normalized c and the power of two are 64 quadratics each. A rival to measure burnish_exact beside.
//   exponent_i  U10.0, 1 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 2 to OutBits + 12
//   value_o     c^exponent (2^OutBits - 1): full at c = 1, 0 at c = 0; it may fall by one as c rises
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 3 to 16.
// LogBits and the tables' images belong together: `burnish hw generate --method quadratics`.
module burnish_quadratics #(
  parameter int CosineBits = 15,
  parameter int OutBits    = 8,
  parameter bit Versine    = 0,
  parameter int Depth      = 3,
  parameter int LogBits    = 19,
  parameter     LogFile    = "log.mem",
  parameter     ExpFile    = "exp.mem"
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
  localparam int FractionBits = OutBits + 2;   // of exponent * u
  localparam int LogLowBits   = CosineBits - 7;
  localparam int LogWordBits  = 3 * LogBits - 17;
  localparam int ExpBits      = OutBits + 3;
  localparam int ExpLowBits   = FractionBits - 6;
  localparam int ExpBendBits  = ExpBits > 13 ? ExpBits - 13 : 0;
  localparam int ExpWordBits  = 2 * ExpBits - 6 + ExpBendBits;
  // Where the pipeline is cut as Depth grows beyond input, table and output.
  localparam int LogCuts     = (Depth > 6 ? 1 : 0) | (Depth > 7 ? 2 : 0) | (Depth > 4 ? 4 : 0);
  localparam int ProductCuts = (Depth > 12 ? 1 : 0) | (Depth > 11 ? 2 : 0) | (Depth > 8 ? 4 : 0) | (Depth > 3 ? 8 : 0);
  localparam int ExpCuts     = (Depth > 9 ? 1 : 0) | (Depth > 13 ? 2 : 0) | (Depth > 5 ? 4 : 0);
  localparam bit CutNormal   = Depth > 10;
  localparam bit CutExpTable = Depth > 14;
  localparam bit CutShift    = Depth > 15;

  logic                    advance, zero, overflow, beyond, unused;
  logic [9:0]              exponent_q;
  logic [CosineBits:0]     cosine;
  logic [CosineBits-1:0]   versine, normal;
  logic [3:0]              octave;
  logic                    tiny;
  logic [CosineBits+14:0]  along_d, along;   // exponent, octave, zero, one, mantissa
  logic [CosineBits-2:0]   mantissa;
  logic [15:0]             beside [0:3];  // exponent, octave, zero, one: along with the logarithm
  logic [LogBits-1:0]      log, log_used;
  logic [LogWordBits-1:0]  log_word;
  logic [LogLowBits-1:0]   log_low;
  logic [FractionBits+3:0] power;
  logic [OutBits-1:0]      value;

  burnish_flow #(.Depth(Depth)) i_flow (
    .clk_i, .rst_ni, .valid_i, .ready_o, .valid_o, .ready_i, .advance_o(advance)
  );
  burnish_cut #(.Width(10)) i_exponent (
    .clk_i, .advance_i(advance), .data_i(exponent_i), .data_o(exponent_q)
  );
  burnish_input #(.CosineBits(CosineBits), .Versine(Versine)) i_input (
    .clk_i, .advance_i(advance), .input_i, .cosine_o(cosine), .versine_o(versine), .zero_o(zero)
  );

  // c = 2^-octave (1 + mantissa) / 2
  logic [CosineBits-1:0] by8, by4, by2;
  logic                  skip8, skip4, skip2, skip1;
  assign skip8 = ~|cosine[CosineBits-1-:8];
  assign by8 = skip8 ? cosine[CosineBits-1:0] << 8 : cosine[CosineBits-1:0];
  assign skip4 = ~|by8[CosineBits-1-:4];
  assign by4 = skip4 ? by8 << 4 : by8;
  assign skip2 = ~|by4[CosineBits-1-:2];
  assign by2 = skip2 ? by4 << 2 : by4;
  assign skip1 = ~by2[CosineBits-1];
  assign normal = skip1 ? by2 << 1 : by2;
  assign octave = {skip8, skip4, skip2, skip1};
  assign tiny = ~normal[CosineBits-1];  // 0, or below 2^-16
  assign along_d = {exponent_q, octave, tiny & ~cosine[CosineBits], cosine[CosineBits], normal[CosineBits-2:0]};
  burnish_cut #(.Width(CosineBits + 15), .Enable(CutNormal)) i_normal (
    .clk_i, .advance_i(advance), .data_i(along_d), .data_o(along)
  );
  assign mantissa = along[CosineBits-2:0];
  burnish_rom #(.AddressBits(6), .Width(LogWordBits), .File(LogFile)) i_rom (
    .clk_i, .advance_i(advance), .address_i(mantissa[CosineBits-2-:6]), .word_o(log_word)
  );
  burnish_cut #(.Width(LogLowBits + 16)) i_table (
    .clk_i, .advance_i(advance), .data_i({mantissa[LogLowBits-1:0], along[CosineBits+14-:16]}),
    .data_o({log_low, beside[0]})
  );
  burnish_quadratic #(
    .LowBits(LogLowBits), .ValueBits(LogBits), .FallBits(LogBits - 5), .BendBits(LogBits - 12), .Cuts(LogCuts)
  ) i_log (
    .clk_i, .advance_i(advance), .word_i(log_word), .low_i(log_low), .value_o(log)
  );
  for (genvar i = 0; i < 3; i++) begin : gen_beside
    burnish_cut #(.Width(16), .Enable(LogCuts[i])) i_cut (
      .clk_i, .advance_i(advance), .data_i(beside[i]), .data_o(beside[i+1])
    );
  end
  assign log_used = log & {LogBits{~beside[3][0]}};

  logic [4:0] tiny_u;
  burnish_product #(
    .ABits(10), .BBits(LogBits + 4), .Drop(LogBits - FractionBits), .OutBits(FractionBits + 4), .Saturate(1),
    .Cuts(ProductCuts)
  ) i_product (
    .clk_i, .advance_i(advance), .a_i(beside[3][15:6]), .b_i({beside[3][5:2] & {4{~beside[3][0]}}, log_used}),
    .product_o(power), .overflow_o(beyond)
  );
  assign tiny_u[0] = beside[3][1];
  for (genvar i = 0; i < 4; i++) begin : gen_tiny
    burnish_cut #(.Width(1), .Enable(ProductCuts[i])) i_tiny (
      .clk_i, .advance_i(advance), .data_i(tiny_u[i]), .data_o(tiny_u[i+1])
    );
  end
  assign overflow = beyond | tiny_u[4];

  // 2^-p: the fraction is a quadratic, the whole part shifts
  logic [ExpWordBits-1:0] exp_word_t, exp_word;
  logic [ExpLowBits-1:0]  exp_low;
  logic [4:0]             whole [0:3];
  logic [ExpBits-1:0]     power_of_two;
  logic [OutBits:0]       shifted, shifted_q, rounded;
  burnish_table #(.AddressBits(6), .Width(ExpWordBits), .File(ExpFile)) i_exp_table (
    .address_i(power[FractionBits-1-:6]), .word_o(exp_word_t)
  );
  burnish_cut #(.Width(ExpWordBits + ExpLowBits + 5), .Enable(CutExpTable)) i_exp_word (
    .clk_i, .advance_i(advance), .data_i({exp_word_t, power[ExpLowBits-1:0], overflow, power[FractionBits+:4]}),
    .data_o({exp_word, exp_low, whole[0]})
  );
  burnish_quadratic #(
    .LowBits(ExpLowBits), .ValueBits(ExpBits), .FallBits(ExpBits - 6), .BendBits(ExpBendBits), .Cuts(ExpCuts)
  ) i_exp (
    .clk_i, .advance_i(advance), .word_i(exp_word), .low_i(exp_low), .value_o(power_of_two)
  );
  for (genvar i = 0; i < 3; i++) begin : gen_whole
    burnish_cut #(.Width(5), .Enable(ExpCuts[i])) i_cut (
      .clk_i, .advance_i(advance), .data_i(whole[i]), .data_o(whole[i+1])
    );
  end
  assign shifted = whole[3][4] ? '0 : power_of_two[ExpBits-1:2] >> whole[3][3:0];
  burnish_cut #(.Width(OutBits + 1), .Enable(CutShift)) i_shifted (
    .clk_i, .advance_i(advance), .data_i(shifted), .data_o(shifted_q)
  );
  assign rounded = shifted_q + 1'b1;
  assign value = rounded[OutBits:1];
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
  assign unused = ^{versine, zero, by2, power_of_two[1:0], rounded[0]};
endmodule
