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

`ifdef FORMAL
  // Numbers travel with the values: each value taken is handed over once, in order, and stays while it waits.
  logic [7:0]         taken_q, given_q;
  logic [8*Depth-1:0] numbers_q;
  logic               waited_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {taken_q, given_q, waited_q} <= '0;
    end else begin
      if (valid_i && ready_o) taken_q <= taken_q + 1'b1;
      if (valid_o && ready_i) given_q <= given_q + 1'b1;
      if (advance_o) numbers_q <= {numbers_q[8*Depth-9:0], taken_q};
      waited_q <= valid_o && !ready_i;
    end
  end
  initial assume (!rst_ni);
  logic [7:0] expected;
  always_comb begin
    expected = given_q;
    for (int i = Depth - 1; i >= 0; i--) begin
      if (valid_q[i]) begin
        assert (numbers_q[8*i+:8] == expected);
        expected = expected + 1'b1;
      end
    end
    assert (expected == taken_q);
    if (waited_q) assert (valid_o);
  end
`endif
endmodule
