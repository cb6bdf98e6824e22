// max(0, m - n s)^2 + o with s = e v, v = 1 - c: m, n and o of the near piece up to s = split, of the far piece
// (o = 0) from there on. They depend on e slowly; 24 rows, chosen by its leading bits, are tables in logic. No
// block RAM. Exponent 1 is c itself.
//   exponent_i  U10.0, 1 to 1023
//   input_i     Q1.CosineBits in [0, 1]: c, or with Versine v = 1 - c; CosineBits from OutBits + 5 to 24
//   value_o     the result times 2^OutBits - 1, full at c = 1, 0 at c = 0, never falling as c rises
// Error against c^exponent: 0.0146, the definition's, 0.002 of the rows, and 1 of the last place.
// One value a clock, valid/ready on both sides. Latency: Depth clocks, from 2 to 9.
// The tables: `burnish hw generate --method two_piece`.
module burnish_two_piece #(
  parameter int CosineBits      = 15,
  parameter int CoefficientBits = 12,  // of n, Q0
  parameter int OutBits         = 8,
  parameter bit Versine         = 0,
  parameter int Depth           = 2,
  parameter     SplitFile       = "split.mem",  // split, o
  parameter     NearFile        = "near.mem",   // m, n
  parameter     FarFile         = "far.mem"
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
  localparam int WholeBits    = 3;  // of s: 8 and more gives 0
  // Where the pipeline is cut as Depth grows beyond input and output.
  localparam bit CutFall         = Depth > 2;
  localparam bit CutDistance     = Depth > 3;
  localparam bit CutScale        = Depth > 4;
  localparam bit CutFallHalf     = Depth > 5;
  localparam bit CutDistanceHalf = Depth > 6;
  localparam bit CutSquareHalf   = Depth > 7;
  localparam bit CutChoice       = Depth > 8;

  localparam int RowBits = 2 * FractionBits + 2 * CoefficientBits + 2 * FractionBits + 2;

  logic                              advance, zero, zero_m, overflow, unused_fall, unused_square;
  logic                              one, one_m, one_s, none, none_s, far;
  logic [9:0]                        exponent_q;
  logic [CosineBits:0]               cosine;
  logic [CosineBits-1:0]             versine;
  logic [4:0]                        row;
  logic [RowBits-1:0]                rows, rows_m, rows_s;
  logic [FractionBits+1:0]           split;
  logic [FractionBits-1:0]           o, m_near, m_far, m, m_c, m_h, w, w_w, square;
  logic [CoefficientBits-1:0]        n_near, n_far, n, n_c;
  logic [FractionBits+WholeBits-1:0] s, s_s, s_c, fall;
  // what is added to the square: o, or c itself for exponent 1 (whose rows are 0)
  logic [FractionBits:0]             top, top_m, top_s, side, side_c, side_h, side_w, side_q, z, z_q;
  logic [OutBits-1:0]                value;

  burnish_flow #(.Depth(Depth)) i_flow (
    .clk_i, .rst_ni, .valid_i, .ready_o, .valid_o, .ready_i, .advance_o(advance)
  );
  burnish_cut #(.Width(10)) i_exponent (
    .clk_i, .advance_i(advance), .data_i(exponent_i), .data_o(exponent_q)
  );
  burnish_input #(.CosineBits(CosineBits), .Versine(Versine)) i_input (
    .clk_i, .advance_i(advance), .input_i, .cosine_o(cosine), .versine_o(versine), .zero_o(zero)
  );
  assign one = exponent_q[9:1] == '0;
  assign row = exponent_q[9:7] != '0 ? 5'd23
             : exponent_q[6] ? 5'd22
             : exponent_q[5] ? {4'b1010, exponent_q[4]}
             : exponent_q[4] ? {3'b100, exponent_q[3:2]}
             : {1'b0, exponent_q[3:0]};
  burnish_table #(.AddressBits(5), .Width(2 * FractionBits + 2), .Words(24), .File(SplitFile)) i_split (
    .address_i(row), .word_o(rows[RowBits-1-:2*FractionBits+2])
  );
  burnish_table #(.AddressBits(5), .Width(FractionBits + CoefficientBits), .Words(24), .File(NearFile)) i_near (
    .address_i(row), .word_o(rows[FractionBits+CoefficientBits+:FractionBits+CoefficientBits])
  );
  burnish_table #(.AddressBits(5), .Width(FractionBits + CoefficientBits), .Words(24), .File(FarFile)) i_far (
    .address_i(row), .word_o(rows[0+:FractionBits+CoefficientBits])
  );
  burnish_rescale #(.From(CosineBits), .To(FractionBits)) i_top (.x_i(cosine), .x_o(top));
  burnish_product #(
    .ABits(10), .BBits(CosineBits), .Drop(CosineBits - FractionBits), .OutBits(FractionBits + WholeBits),
    .Saturate(1), .Cuts(CutDistanceHalf ? 4 : 0)
  ) i_distance (
    .clk_i, .advance_i(advance), .a_i(exponent_q), .b_i(versine), .product_o(s), .overflow_o(overflow)
  );
  burnish_cut #(.Width(RowBits + FractionBits + 3), .Enable(CutDistanceHalf)) i_distance_half (
    .clk_i, .advance_i(advance), .data_i({rows, top, one, zero}), .data_o({rows_m, top_m, one_m, zero_m})
  );
  assign none = zero_m | overflow;
  burnish_cut #(.Width(RowBits + 2 * FractionBits + WholeBits + 3), .Enable(CutDistance)) i_distance_cut (
    .clk_i, .advance_i(advance), .data_i({s, rows_m, top_m, one_m, none}), .data_o({s_s, rows_s, top_s, one_s, none_s})
  );

  assign {split, o, m_near, n_near, m_far, n_far} = rows_s;
  assign far = s_s >= {1'b0, split};
  assign m = none_s ? '0 : far ? m_far : m_near;
  assign n = far ? n_far : n_near;
  assign side = one_s ? top_s : far | none_s ? '0 : {1'b0, o};
  burnish_cut #(.Width(3 * FractionBits + WholeBits + CoefficientBits + 1), .Enable(CutChoice)) i_choice (
    .clk_i, .advance_i(advance), .data_i({s_s, m, n, side}), .data_o({s_c, m_c, n_c, side_c})
  );
  burnish_product #(
    .ABits(CoefficientBits), .BBits(FractionBits + WholeBits), .Drop(CoefficientBits), .OutBits(FractionBits + WholeBits),
    .Saturate(0), .Cuts(CutFallHalf ? 4 : 0)
  ) i_fall (
    .clk_i, .advance_i(advance), .a_i(n_c), .b_i(s_c), .product_o(fall), .overflow_o(unused_fall)
  );
  burnish_cut #(.Width(2 * FractionBits + 1), .Enable(CutFallHalf)) i_fall_half (
    .clk_i, .advance_i(advance), .data_i({m_c, side_c}), .data_o({m_h, side_h})
  );
  assign w = fall > {{WholeBits{1'b0}}, m_h} ? '0 : m_h - fall[FractionBits-1:0];
  burnish_cut #(.Width(2 * FractionBits + 1), .Enable(CutFall)) i_w (
    .clk_i, .advance_i(advance), .data_i({w, side_h}), .data_o({w_w, side_w})
  );
  burnish_product #(
    .ABits(FractionBits), .BBits(FractionBits), .Drop(FractionBits), .OutBits(FractionBits),
    .Saturate(0), .Cuts(CutSquareHalf ? 4 : 0)
  ) i_square (
    .clk_i, .advance_i(advance), .a_i(w_w), .b_i(w_w), .product_o(square), .overflow_o(unused_square)
  );
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutSquareHalf)) i_square_half (
    .clk_i, .advance_i(advance), .data_i(side_w), .data_o(side_q)
  );
  assign z = {1'b0, square} + side_q;
  burnish_cut #(.Width(FractionBits + 1), .Enable(CutScale)) i_z (
    .clk_i, .advance_i(advance), .data_i(z), .data_o(z_q)
  );
  burnish_scale #(.FractionBits(FractionBits), .OutBits(OutBits)) i_scale (.z_i(z_q), .value_o(value));
  burnish_cut #(.Width(OutBits)) i_output (.clk_i, .advance_i(advance), .data_i(value), .data_o(value_o));
endmodule
