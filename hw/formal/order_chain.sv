// The exact unit as a whole, any pauses of the receiver: of two questions in turn with one exponent, chosen by their
// number, the one of smaller c does not get the larger answer. The table stages are replaced by what is proved of
// their order (chain/), so this is about all between them: input, octaves, and that what belongs together meets.
module order_chain #(
  parameter int Depth = 3
) (
  input logic        clk_i,
  input logic        ready_i,
  input logic [9:0]  exponent_i,
  input logic [15:0] input_i
);
  logic        rst_n_q = 1'b0, ready, valid;
  (* anyconst *) logic [4:0] second;
  logic [4:0]  taken_q = '0, given_q = '0;
  logic [9:0]  exponent_q;
  logic [15:0] input_q;
  logic [7:0]  value, value_q;

  burnish_exact #(.Depth(Depth)) i_unit (
    .clk_i, .rst_ni(rst_n_q), .valid_i(1'b1), .ready_o(ready), .exponent_i, .input_i,
    .valid_o(valid), .ready_i, .value_o(value)
  );
  always_ff @(posedge clk_i) begin
    rst_n_q <= 1'b1;
    if (rst_n_q && ready) {taken_q, exponent_q, input_q} <= {taken_q + 1'b1, exponent_i, input_i};
    if (rst_n_q && valid && ready_i) {given_q, value_q} <= {given_q + 1'b1, value};
  end
  always_comb begin
    assume (second != '0 && taken_q != '1);
    if (taken_q == second) assume (exponent_i == exponent_q && input_i <= input_q);
    if (rst_n_q && valid && given_q == second) assert (value <= value_q);
  end
endmodule
