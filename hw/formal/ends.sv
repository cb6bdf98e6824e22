// The exact unit as a whole, any exponent: c = 0 gives 0; c = 1 and input words above it give all ones.
module ends #(
  parameter int Depth = 3
) (
  input logic       clk_i,
  input logic [9:0] exponent_i
);
  localparam logic [47:0] Inputs = {16'hffff, 16'h8000, 16'h0000};
  logic rst_n_q = 1'b0;
  always_ff @(posedge clk_i) rst_n_q <= 1'b1;
  always_comb assume (exponent_i != '0);
  for (genvar i = 0; i < 3; i++) begin : gen_end
    logic       valid, unused_ready;
    logic [7:0] value;
    burnish_exact #(.Depth(Depth)) i_unit (
      .clk_i, .rst_ni(rst_n_q), .valid_i(1'b1), .ready_o(unused_ready), .exponent_i, .input_i(Inputs[16*i+:16]),
      .valid_o(valid), .ready_i(1'b1), .value_o(value)
    );
    always_comb if (rst_n_q && valid) assert (value == {8{i != 0}});
  end
endmodule
