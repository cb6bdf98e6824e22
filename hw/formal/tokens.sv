// The exact unit as a whole, any pauses: only c = 0 and c = 1 are offered, and the answer to any one question,
// chosen by its number, is its own: none is lost, doubled or overtaken.
module tokens #(
  parameter int         Depth    = 3,
  parameter logic [9:0] Exponent = 10'd1023
) (
  input logic clk_i,
  input logic valid_i,
  input logic ready_i,
  input logic one_i
);
  (* anyconst *) logic [3:0] number;
  logic       rst_n_q = 1'b0, ready, valid, seen_q = 1'b0, one_q = 1'b0;
  logic [3:0] taken_q = '0, given_q = '0;
  logic [7:0] value;

  burnish_exact #(.Depth(Depth)) i_unit (
    .clk_i, .rst_ni(rst_n_q), .valid_i, .ready_o(ready), .exponent_i(Exponent), .input_i({one_i, 15'b0}),
    .valid_o(valid), .ready_i, .value_o(value)
  );

  always_ff @(posedge clk_i) begin
    rst_n_q <= 1'b1;
    assume (taken_q != '1);
    if (rst_n_q) begin
      if (valid_i && ready) begin
        taken_q <= taken_q + 1'b1;
        if (taken_q == number) begin
          seen_q <= 1'b1;
          one_q <= one_i;
        end
      end
      if (valid && ready_i) given_q <= given_q + 1'b1;
      if (valid) begin
        assert (taken_q != given_q);
        if (given_q == number) assert (seen_q && value == {8{one_q}});
      end
    end
  end
endmodule
