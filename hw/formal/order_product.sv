// For each of Count constants a from First on: floor(a b / 2^Drop), overflow above all values, never falls as b
// rises, and is 0 for b = 0.
module order_product #(
  parameter int ABits   = 10,
  parameter int BBits   = 22,
  parameter int Drop    = 9,
  parameter int OutBits = 14,
  parameter int First   = 1,
  parameter int Count   = 8
) (
  input logic [BBits-1:0] b_i
);
  logic [BBits-1:0] b_next;
  assign b_next = b_i + 1'b1;
  always_comb assume (b_i != {BBits{1'b1}});

  for (genvar i = 0; i < Count; i++) begin : gen_constant
    localparam int A = First + i;
    logic [OutBits-1:0] low, low_next;
    logic               overflow, overflow_next;
    burnish_product #(.ABits(ABits), .BBits(BBits), .Drop(Drop), .OutBits(OutBits), .Saturate(1)) i_product (
      .clk_i(1'b0), .advance_i(1'b1), .a_i(A[ABits-1:0]), .b_i, .product_o(low), .overflow_o(overflow)
    );
    burnish_product #(.ABits(ABits), .BBits(BBits), .Drop(Drop), .OutBits(OutBits), .Saturate(1)) i_next (
      .clk_i(1'b0), .advance_i(1'b1), .a_i(A[ABits-1:0]), .b_i(b_next), .product_o(low_next),
      .overflow_o(overflow_next)
    );
    always_comb begin
      assert (overflow_next || !overflow && low <= low_next);
      if (b_i == '0) assert (!overflow && low == '0);
    end
  end
endmodule
