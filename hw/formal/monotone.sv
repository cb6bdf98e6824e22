// Two copies of the exact unit without back-pressure, one step of the input apart: the value never falls as c rises.
module monotone #(
  parameter int Exponent = 1000,
  parameter int Depth    = 3
) (
  input logic        clk_i,
  input logic [15:0] cosine_i
);
  logic [7:0] value_a, value_b, clocks_q;
  logic       ready_a, ready_b, valid_a, valid_b;
  logic       unused;
  initial clocks_q = '0;

  burnish_exact #(.Depth(Depth)) i_a (
    .clk_i, .rst_ni(1'b1), .valid_i(1'b1), .ready_o(ready_a), .exponent_i(Exponent[9:0]), .input_i(cosine_i),
    .valid_o(valid_a), .ready_i(1'b1), .value_o(value_a)
  );
  burnish_exact #(.Depth(Depth)) i_b (
    .clk_i, .rst_ni(1'b1), .valid_i(1'b1), .ready_o(ready_b), .exponent_i(Exponent[9:0]), .input_i(cosine_i + 16'd1),
    .valid_o(valid_b), .ready_i(1'b1), .value_o(value_b)
  );
  assign unused = ^{ready_a, ready_b, valid_a, valid_b};

  always @(posedge clk_i) begin
    clocks_q <= clocks_q + 1'b1;
    assume (cosine_i < 16'd32768);
    if (clocks_q == Depth) assert (value_a <= value_b);
  end
endmodule
