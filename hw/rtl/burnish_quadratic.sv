// One of 64 quadratics: start - fall t + bend t^2, where t in [0, 1) is the low bits of x_i. Both products are
// truncated.
// Words of the table: start (ValueBits), fall (FallBits) and, in the low bits, bend (BendBits, 0 for none), in steps of
// the last place of value_o.
// Latency: the number of bits set in Cuts: bit 0 behind the products with t, 1 behind the product with t^2, 2 behind
// the sum.
module burnish_quadratic #(
  parameter int LowBits   = 8,
  parameter int ValueBits = 19,
  parameter int FallBits  = 14,
  parameter int BendBits  = 7,
  parameter int Cuts      = 0
) (
  input  logic                                   clk_i,
  input  logic                                   advance_i,
  input  logic [ValueBits+FallBits+BendBits-1:0] word_i,
  input  logic [LowBits-1:0]                     low_i,
  output logic [ValueBits-1:0]                   value_o
);
  logic [ValueBits-1:0] start, start_q, start_qq, value;
  logic [FallBits-1:0]  fall, fall_q, fall_qq;
  logic                 unused;

  assign start = word_i[ValueBits+FallBits+BendBits-1-:ValueBits];
  burnish_product #(
    .ABits(LowBits), .BBits(FallBits), .Drop(LowBits), .OutBits(FallBits), .Saturate(0)
  ) i_fall (
    .clk_i, .advance_i, .a_i(low_i), .b_i(word_i[FallBits+BendBits-1-:FallBits]), .product_o(fall), .overflow_o(unused)
  );
  burnish_cut #(.Width(ValueBits + FallBits), .Enable(Cuts[0])) i_linear (
    .clk_i, .advance_i, .data_i({start, fall}), .data_o({start_q, fall_q})
  );
  burnish_cut #(.Width(ValueBits + FallBits), .Enable(Cuts[1])) i_wait (
    .clk_i, .advance_i, .data_i({start_q, fall_q}), .data_o({start_qq, fall_qq})
  );
  if (BendBits > 0) begin : gen_bend
    localparam int SquareBits = BendBits + 1 < 2 * LowBits ? BendBits + 1 : 2 * LowBits;
    logic [SquareBits-1:0] square, square_q;
    logic [BendBits-1:0]   bend, bend_q, rise, rise_q;
    logic [1:0]            unused_bend;
    burnish_product #(
      .ABits(LowBits), .BBits(LowBits), .Drop(2 * LowBits - SquareBits), .OutBits(SquareBits), .Saturate(0)
    ) i_square (
      .clk_i, .advance_i, .a_i(low_i), .b_i(low_i), .product_o(square), .overflow_o(unused_bend[0])
    );
    assign bend = word_i[BendBits-1:0];
    burnish_cut #(.Width(SquareBits + BendBits), .Enable(Cuts[0])) i_square_cut (
      .clk_i, .advance_i, .data_i({square, bend}), .data_o({square_q, bend_q})
    );
    burnish_product #(
      .ABits(BendBits), .BBits(SquareBits), .Drop(SquareBits), .OutBits(BendBits), .Saturate(0)
    ) i_rise (
      .clk_i, .advance_i, .a_i(bend_q), .b_i(square_q), .product_o(rise), .overflow_o(unused_bend[1])
    );
    burnish_cut #(.Width(BendBits), .Enable(Cuts[1])) i_rise_cut (
      .clk_i, .advance_i, .data_i(rise), .data_o(rise_q)
    );
    assign value = start_qq - {{(ValueBits - FallBits){1'b0}}, fall_qq} + {{(ValueBits - BendBits){1'b0}}, rise_q};
  end else begin : gen_line
    assign value = start_qq - {{(ValueBits - FallBits){1'b0}}, fall_qq};
  end
  burnish_cut #(.Width(ValueBits), .Enable(Cuts[2])) i_value (.clk_i, .advance_i, .data_i(value), .data_o(value_o));
endmodule
