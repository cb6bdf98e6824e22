// The exact unit as a whole, any pauses of the receiver: questions come in pairs of one exponent and a falling c, and
// the second answer of a pair is not above the first. The table stages are replaced by what is proved of their order
// (chain/), so this is about all between them: input, octaves, and that what belongs together meets.
module order_chain #(
  parameter int Depth = 3
) (
  input logic        clk_i,
  input logic        ready_i,
  input logic [9:0]  exponent_i,
  input logic [15:0] input_i
);
  logic        rst_n_q = 1'b0, ready, valid;
  logic        second_q = 1'b0, second_answer_q = 1'b0;
  logic [9:0]  exponent_q;
  logic [15:0] input_q;
  logic [7:0]  value, value_q;

  burnish_exact #(.Depth(Depth)) i_unit (
    .clk_i, .rst_ni(rst_n_q), .valid_i(1'b1), .ready_o(ready), .exponent_i, .input_i,
    .valid_o(valid), .ready_i, .value_o(value)
  );
  always_ff @(posedge clk_i) begin
    rst_n_q <= 1'b1;
    if (rst_n_q && ready) {second_q, exponent_q, input_q} <= {!second_q, exponent_i, input_i};
    if (rst_n_q && valid && ready_i) {second_answer_q, value_q} <= {!second_answer_q, value};
  end
  always_comb begin
    if (second_q) assume (exponent_i == exponent_q && input_i <= input_q);
    if (rst_n_q && valid && second_answer_q) assert (value <= value_q);
  end
endmodule
