// 2^-p, overflow above all p, never rises with p, is full at p = 0 and 0 from p = OutBits + 2 on.
module order_exp #(
  parameter int OutBits   = 8,
  parameter int IndexBits = 4,
  parameter     File      = "exp.mem"
) (
  input logic [OutBits+6:0] power_i
);
  logic [OutBits+6:0] power_a, power_b;
  logic [OutBits-1:0] value_a, value_b;

  assign power_a = power_i;
  assign power_b = power_i + 1'b1;
  burnish_exp2 #(.OutBits(OutBits), .IndexBits(IndexBits), .File(File)) i_a (
    .clk_i(1'b0), .advance_i(1'b1), .power_i(power_a[OutBits+5:0]), .overflow_i(power_a[OutBits+6]), .value_o(value_a)
  );
  burnish_exp2 #(.OutBits(OutBits), .IndexBits(IndexBits), .File(File)) i_b (
    .clk_i(1'b0), .advance_i(1'b1), .power_i(power_b[OutBits+5:0]), .overflow_i(power_b[OutBits+6]), .value_o(value_b)
  );

  always_comb begin
    assume (power_i != {(OutBits + 7){1'b1}});
    assert (value_a >= value_b);
    if (power_i == '0) assert (value_a == {OutBits{1'b1}});
    if (power_i[OutBits+6:OutBits+2] >= OutBits + 2) assert (value_a == '0);
  end
endmodule
