// max(0, 1 - k v)^8, k = Slope e + Offset, v = 1 - c: no table.
//   exponent_i  U10.0, 5 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 5 to 24
//   value_o     the result times 2^OutBits - 1, full at c = 1, 0 at c = 0, never falling as c rises
// Error against c^exponent: 0.0161 from exponent 5 on, and 1 of the last place.
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 2 to 11.
// Slope and Offset: `burnish hw generate --method w8`.
module burnish_w8 #(
  parameter int CosineBits      = 15,
  parameter int CoefficientBits = 16,  // of k, U7.(CoefficientBits - 7)
  parameter int OutBits         = 8,
  parameter bit Versine         = 0,
  parameter int Depth           = 2,
  parameter int Slope           = 471,  // with SlopeBits fraction bits
  parameter int Offset          = 314,
  parameter int SlopeBits       = 12
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
  localparam int FractionBits = OutBits + 5;
  // Where the pipeline is cut as Depth grows beyond input and output.
  localparam bit CutSquare      = Depth > 2;
  localparam bit CutFactor      = Depth > 3;
  localparam bit CutFourth      = Depth > 4;
  localparam bit CutScale       = Depth > 5;
  localparam bit CutMiddle      = Depth > 6;
  localparam bit CutSquareHalf  = Depth > 7;
  localparam bit CutFourthHalf  = Depth > 8;
  localparam bit CutEighthHalf  = Depth > 9;
  localparam bit CutCoefficient = Depth > 10;

  logic                       advance, zero, overflow, unused;
  logic [2:0]                 unused_product;
  logic [9:0]                 exponent_q;
  logic [CosineBits:0]        cosine;
  logic [CosineBits-1:0]      versine, versine_k;
  logic [SlopeBits+6:0]       affine;
  logic [CoefficientBits-1:0] k, k_k;
  logic [FractionBits-1:0]    fall;
  logic [FractionBits:0]      factor, factor_f, square, square_f, fourth, fourth_f, z, z_q;
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
  assign unused = ^{cosine, zero};
  assign affine = exponent_q * Slope[SlopeBits+6:0] + Offset[SlopeBits+6:0];
  burnish_rescale #(.From(SlopeBits + 6), .To(CoefficientBits - 1)) i_k (.x_i(affine), .x_o(k));
  burnish_cut #(.Width(CoefficientBits + CosineBits), .Enable(CutCoefficient)) i_coefficient (
    .clk_i, .advance_i(advance), .data_i({k, versine}), .data_o({k_k, versine_k})
  );
  burnish_product #(
    .ABits(CosineBits), .BBits(CoefficientBits), .Drop(CoefficientBits - 7 + CosineBits - FractionBits), .OutBits(FractionBits),
    .Saturate(1), .Cuts(CutMiddle ? 4 : 0)
  ) i_fall (
    .clk_i, .advance_i(advance), .a_i(versine_k), .b_i(k_k), .product_o(fall), .overflow_o(overflow)
  );
  assign factor = overflow ? '0 : {1'b1, {FractionBits{1'b0}}} - {1'b0, fall};
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutFactor)) i_factor (
    .clk_i, .advance_i(advance), .data_i(factor), .data_o(factor_f)
  );
  burnish_product #(
    .ABits(FractionBits + 1), .BBits(FractionBits + 1), .Drop(FractionBits), .OutBits(FractionBits + 1),
    .Saturate(0), .Cuts(CutSquareHalf ? 4 : 0)
  ) i_square (
    .clk_i, .advance_i(advance), .a_i(factor_f), .b_i(factor_f), .product_o(square), .overflow_o(unused_product[0])
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutSquare)) i_square_cut (
    .clk_i, .advance_i(advance), .data_i(square), .data_o(square_f)
  );
  burnish_product #(
    .ABits(FractionBits + 1), .BBits(FractionBits + 1), .Drop(FractionBits), .OutBits(FractionBits + 1),
    .Saturate(0), .Cuts(CutFourthHalf ? 4 : 0)
  ) i_fourth (
    .clk_i, .advance_i(advance), .a_i(square_f), .b_i(square_f), .product_o(fourth), .overflow_o(unused_product[1])
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutFourth)) i_fourth_cut (
    .clk_i, .advance_i(advance), .data_i(fourth), .data_o(fourth_f)
  );
  burnish_product #(
    .ABits(FractionBits + 1), .BBits(FractionBits + 1), .Drop(FractionBits), .OutBits(FractionBits + 1),
    .Saturate(0), .Cuts(CutEighthHalf ? 4 : 0)
  ) i_eighth (
    .clk_i, .advance_i(advance), .a_i(fourth_f), .b_i(fourth_f), .product_o(z), .overflow_o(unused_product[2])
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutScale)) i_z (
    .clk_i, .advance_i(advance), .data_i(z), .data_o(z_q)
  );
  burnish_scale #(.FractionBits(FractionBits), .OutBits(OutBits)) i_scale (.z_i(z_q), .value_o(value));
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
endmodule
