// floor(a b / 2^Drop), overflow above all values, never falls as b rises, and is 0 for b = 0.
module order_product #(
  parameter int ABits   = 10,
  parameter int BBits   = 24,
  parameter int Drop    = 10,
  parameter int OutBits = 14
) (
  input logic [ABits-1:0] a_i,
  input logic [BBits-1:0] b_i
);
  logic [BBits-1:0] b_a, b_b;
  logic [OutBits:0] product_a, product_b;

  logic [OutBits-1:0] low_a, low_b;
  logic               overflow_a, overflow_b;

  assign b_a = b_i;
  assign b_b = b_i + 1'b1;
  burnish_product #(.ABits(ABits), .BBits(BBits), .Drop(Drop), .OutBits(OutBits), .Saturate(1)) i_a (
    .clk_i(1'b0), .advance_i(1'b1), .a_i, .b_i(b_a), .product_o(low_a), .overflow_o(overflow_a)
  );
  burnish_product #(.ABits(ABits), .BBits(BBits), .Drop(Drop), .OutBits(OutBits), .Saturate(1)) i_b (
    .clk_i(1'b0), .advance_i(1'b1), .a_i, .b_i(b_b), .product_o(low_b), .overflow_o(overflow_b)
  );
  assign product_a = overflow_a ? {1'b1, {OutBits{1'b0}}} : {1'b0, low_a};
  assign product_b = overflow_b ? {1'b1, {OutBits{1'b0}}} : {1'b0, low_b};

  always_comb begin
    assume (b_i != {BBits{1'b1}});
    assert (product_a <= product_b);
    if (b_i == '0) assert (product_a == '0);
  end
endmodule
