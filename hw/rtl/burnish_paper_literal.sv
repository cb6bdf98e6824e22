// The paper's block (figure 1): a (c^2 - c) + c, clamped at 0. RG1 (exponent) addresses the PROM of a, RG2 (c)
// is squared; subtractor, second multiplier and adder follow: c - c^2 >= 0 is multiplied and taken from c.
//   exponent_i  U10.0, 1 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 5 to 24
//   value_o     the result times 2^OutBits - 1, full at c = 1, 0 at c = 0; from exponent 4 on never falling as c rises
// Error against c^exponent: 0.285, the parabola's (its tail is cut), and 1 of the last place.
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 3 to 8.
// PromFile: `burnish hw generate --method paper_literal`.
module burnish_paper_literal #(
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
  localparam int FineBits     = OutBits + 12;  // of c^2: a multiplies what is cut
  // Where the pipeline is cut as Depth grows beyond input, PROM and output.
  localparam bit CutPower  = Depth > 3;
  localparam bit CutSquare = Depth > 4;
  localparam bit CutMiddle = Depth > 5;
  localparam bit CutHalf   = Depth > 6;
  localparam bit CutScale  = Depth > 7;

  logic                       advance, zero, overflow, unused_square, unused;
  logic [9:0]                 exponent_q, exponent_s;
  logic [CosineBits:0]        cosine, cosine_h, cosine_s;
  logic [CosineBits-1:0]      versine;
  logic [FineBits:0]          square, square_s, fine, fall_d;
  logic [FineBits-2:0]        fall;  // c - c^2 <= 1/4
  logic [CoefficientBits-1:0] coefficient;
  logic [FractionBits:0]      top, top_f, top_m, top_p, rest, z, z_q;
  logic [FractionBits-1:0]    power, power_p;
  logic                       overflow_p;
  logic [9:0]                 exponent_h;
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
  assign unused = ^{versine, zero, fall_d[FineBits:FineBits-1]};

  burnish_product #(
    .ABits(CosineBits + 1), .BBits(CosineBits + 1), .Drop(2 * CosineBits - FineBits), .OutBits(FineBits + 1),
    .Saturate(0), .Cuts(CutHalf ? 4 : 0)
  ) i_square (
    .clk_i, .advance_i(advance), .a_i(cosine), .b_i(cosine), .product_o(square), .overflow_o(unused_square)
  );
  burnish_cut #(.Width(CosineBits + 11), .Enable(CutHalf)) i_half (
    .clk_i, .advance_i(advance), .data_i({exponent_q, cosine}), .data_o({exponent_h, cosine_h})
  );
  burnish_cut #(.Width(FineBits + CosineBits + 12), .Enable(CutSquare)) i_square_cut (
    .clk_i, .advance_i(advance), .data_i({square, exponent_h, cosine_h}), .data_o({square_s, exponent_s, cosine_s})
  );
  burnish_rescale #(.From(CosineBits), .To(FineBits)) i_fine (.x_i(cosine_s), .x_o(fine));
  burnish_rescale #(.From(CosineBits), .To(FractionBits)) i_top (.x_i(cosine_s), .x_o(top));
  assign fall_d = fine - square_s;

  burnish_rom #(.AddressBits(10), .Width(CoefficientBits), .File(PromFile)) i_prom (
    .clk_i, .advance_i(advance), .address_i(exponent_s), .word_o(coefficient)
  );
  burnish_cut #(.Width(FineBits + FractionBits)) i_fall (
    .clk_i, .advance_i(advance), .data_i({fall_d[FineBits-2:0], top}), .data_o({fall, top_f})
  );
  burnish_product #(
    .ABits(CoefficientBits), .BBits(FineBits - 1), .Drop(CoefficientBits - 2), .OutBits(FractionBits),
    .Saturate(1), .Cuts(CutMiddle ? 4 : 0)
  ) i_power (
    .clk_i, .advance_i(advance), .a_i(coefficient), .b_i(fall), .product_o(power), .overflow_o(overflow)
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutMiddle)) i_middle (
    .clk_i, .advance_i(advance), .data_i(top_f), .data_o(top_m)
  );
  burnish_cut #(.Width(2 * FractionBits + 2), .Enable(CutPower)) i_power_cut (
    .clk_i, .advance_i(advance), .data_i({power, overflow, top_m}), .data_o({power_p, overflow_p, top_p})
  );
  assign rest = top_p - {1'b0, power_p};
  assign z = overflow_p | {1'b0, power_p} > top_p ? '0 : rest;
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutScale)) i_z (
    .clk_i, .advance_i(advance), .data_i(z), .data_o(z_q)
  );
  burnish_scale #(.FractionBits(FractionBits), .OutBits(OutBits)) i_scale (.z_i(z_q), .value_o(value));
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
endmodule
