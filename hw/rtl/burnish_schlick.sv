// Schlick's c / (c + e v), v = 1 - c: a multiplier, an adder and a divider, for comparison.
//   exponent_i  U10.0, 1 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 5 to 24
//   value_o     the result times 2^OutBits - 1, full at c = 1, 0 at c = 0, never falling as c rises
// Error against c^exponent: 0.204, the definition's, and 1 of the last place.
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 2 to 13.
module burnish_schlick #(
  parameter int CosineBits      = 15,
  parameter int OutBits         = 8,
  parameter bit Versine         = 0,
  parameter int Depth           = 2
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
  localparam int FractionBits = OutBits + 2;
  localparam int Width        = CosineBits + 11;  // of c + e v, and one bit for the doubled remainder
  // Where the pipeline is cut as Depth grows beyond input and output: before the divider, in it, in the product.
  localparam bit CutSum   = Depth > 2;
  localparam bit CutHalf  = Depth > 11;
  localparam int RowCuts  = Depth < 4 ? 0 : Depth - (CutHalf ? 4 : 3);

  logic                  advance, zero, unused, unused_product;
  logic [9:0]            exponent_q;
  logic [CosineBits:0]   cosine, cosine_h, numerator;
  logic [CosineBits-1:0] versine;
  logic [CosineBits+9:0] product;
  logic [Width-1:0]      sum, denominator;
  logic [FractionBits:0] quotient;
  logic [OutBits-1:0]    value;

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
  burnish_product #(
    .ABits(10), .BBits(CosineBits), .Drop(0), .OutBits(CosineBits + 10),
    .Saturate(0), .Cuts(CutHalf ? 4 : 0)
  ) i_product (
    .clk_i, .advance_i(advance), .a_i(exponent_q), .b_i(versine), .product_o(product), .overflow_o(unused_product)
  );
  burnish_cut #(.Width(CosineBits + 1), .Enable(CutHalf)) i_half (
    .clk_i, .advance_i(advance), .data_i(cosine), .data_o(cosine_h)
  );
  assign sum = {1'b0, product} + {10'b0, cosine_h};
  burnish_cut #(.Width(Width + CosineBits + 1), .Enable(CutSum)) i_sum (
    .clk_i, .advance_i(advance), .data_i({sum, cosine_h}), .data_o({denominator, numerator})
  );
  burnish_divider #(.Width(Width), .FractionBits(FractionBits), .Cuts(RowCuts)) i_divider (
    .clk_i, .advance_i(advance), .numerator_i({10'b0, numerator}), .denominator_i(denominator), .quotient_o(quotient)
  );
  burnish_scale #(.FractionBits(FractionBits), .OutBits(OutBits)) i_scale (.z_i(quotient), .value_o(value));
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
endmodule
