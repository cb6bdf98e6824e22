// The paper's parabola, factorised: c max(0, 1 - a v), v = 1 - c. What is multiplied is never negative, and
// every step keeps the order, so the result never falls as c rises.
//   exponent_i  U10.0, 1 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 5 to 24
//   value_o     the result times 2^OutBits - 1, full at c = 1, 0 at c = 0, never falling as c rises
// Error against c^exponent: 0.285, the parabola's (its tail is cut), and 1 of the last place.
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 3 to 8.
// PromFile: `burnish hw generate --method paper`.
module burnish_paper #(
  parameter int CosineBits      = 15,
  parameter int CoefficientBits = 16,  // of a, U10.(CoefficientBits - 10)
  parameter int OutBits         = 8,
  parameter bit Versine         = 0,
  parameter int Depth           = 3,
  parameter     PromFile        = "prom.mem"
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
  localparam int FractionBits = OutBits + 4;
  // Where the pipeline is cut as Depth grows beyond input, PROM and output.
  localparam bit CutFactor = Depth > 3;
  localparam bit CutMiddle = Depth > 4;
  localparam bit CutScale  = Depth > 5;
  localparam bit CutHalf   = Depth > 6;
  localparam bit CutClamp  = Depth > 7;

  logic                       advance, zero, overflow, overflow_p, unused_product, unused;
  logic [9:0]                 exponent_q;
  logic [CosineBits:0]        cosine;
  logic [CosineBits-1:0]      versine, versine_q;
  logic [CoefficientBits-1:0] coefficient;
  logic [FractionBits-1:0]    fall, fall_p;
  logic [FractionBits:0]      top, top_q, top_m, top_p, top_f, factor, factor_f, z, z_q;
  logic [OutBits-1:0]         value;

  burnish_flow #(.Depth(Depth)) i_flow (
    .clk_i, .rst_ni, .valid_i, .ready_o, .valid_o, .ready_i, .advance_o(advance)
  );
  burnish_cut #(.Width(10)) i_exponent (
    .clk_i, .advance_i(advance), .data_i(exponent_i), .data_o(exponent_q)
  );
  burnish_input #(.CosineBits(CosineBits), .Versine(Versine)) i_input (
    .clk_i, .advance_i(advance), .input_i, .cosine_o(cosine), .versine_o(versine), .zero_o(zero)
  );
  assign unused = zero;
  burnish_rom #(.AddressBits(10), .Width(CoefficientBits), .File(PromFile)) i_prom (
    .clk_i, .advance_i(advance), .address_i(exponent_q), .word_o(coefficient)
  );
  burnish_rescale #(.From(CosineBits), .To(FractionBits)) i_top (.x_i(cosine), .x_o(top));
  burnish_cut #(.Width(CosineBits + FractionBits + 1)) i_fetch (
    .clk_i, .advance_i(advance), .data_i({versine, top}), .data_o({versine_q, top_q})
  );
  burnish_product #(
    .ABits(CosineBits), .BBits(CoefficientBits), .Drop(CoefficientBits - 10 + CosineBits - FractionBits), .OutBits(FractionBits),
    .Saturate(1), .Cuts(CutMiddle ? 4 : 0)
  ) i_fall (
    .clk_i, .advance_i(advance), .a_i(versine_q), .b_i(coefficient), .product_o(fall), .overflow_o(overflow)
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutMiddle)) i_middle (
    .clk_i, .advance_i(advance), .data_i(top_q), .data_o(top_m)
  );
  burnish_cut #(.Width(2 * FractionBits + 2), .Enable(CutClamp)) i_fall_cut (
    .clk_i, .advance_i(advance), .data_i({fall, overflow, top_m}), .data_o({fall_p, overflow_p, top_p})
  );
  assign factor = overflow_p ? '0 : {1'b1, {FractionBits{1'b0}}} - {1'b0, fall_p};
  burnish_cut #(.Width(2 * FractionBits + 2), .Enable(CutFactor)) i_factor (
    .clk_i, .advance_i(advance), .data_i({factor, top_p}), .data_o({factor_f, top_f})
  );
  burnish_product #(
    .ABits(FractionBits + 1), .BBits(FractionBits + 1), .Drop(FractionBits), .OutBits(FractionBits + 1),
    .Saturate(0), .Cuts(CutHalf ? 4 : 0)
  ) i_product (
    .clk_i, .advance_i(advance), .a_i(top_f), .b_i(factor_f), .product_o(z), .overflow_o(unused_product)
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutScale)) i_z (
    .clk_i, .advance_i(advance), .data_i(z), .data_o(z_q)
  );
  burnish_scale #(.FractionBits(FractionBits), .OutBits(OutBits)) i_scale (.z_i(z_q), .value_o(value));
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
endmodule
