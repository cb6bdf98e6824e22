// Valid bits of a pipeline of Depth registers, all of which advance together:
//   a value is taken where valid_i and ready_o, handed over where valid_o and ready_i;
//   advance_o enables every register of the pipeline, so one value moves on a clock and none overtakes.
// Latency: Depth clocks without back-pressure. rst_ni empties the pipeline, asynchronously.
module burnish_flow #(
  parameter int Depth = 3  // 2 or more
) (
  input  logic clk_i,
  input  logic rst_ni,
  input  logic valid_i,
  output logic ready_o,
  output logic valid_o,
  input  logic ready_i,
  output logic advance_o
);
  logic [Depth-1:0] valid_q;

  assign valid_o   = valid_q[Depth-1];
  assign advance_o = ready_i | ~valid_o;
  assign ready_o   = advance_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else if (advance_o) valid_q <= {valid_q[Depth-2:0], valid_i};
  end
endmodule
