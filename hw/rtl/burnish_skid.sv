// A register slice with room for two words, so that ready_o is a register: no path leads from ready_i to ready_o or
// from valid_i to valid_o. One word a clock; latency 1 clock without back-pressure. rst_ni empties it, asynchronously.
module burnish_skid #(
  parameter int Width = 8
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [Width-1:0] data_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [Width-1:0] data_o
);
  logic             full_q, valid_q;  // the spare word, the word at the output
  logic [Width-1:0] spare_q, data_q;
  logic             moves;

  assign ready_o = ~full_q;
  assign valid_o = valid_q;
  assign data_o = data_q;
  assign moves = ready_i | ~valid_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      full_q <= 1'b0;
      valid_q <= 1'b0;
    end else if (moves) begin
      full_q <= 1'b0;
      valid_q <= full_q | valid_i;
    end else begin
      full_q <= full_q | valid_i;
    end
  end
  always_ff @(posedge clk_i) begin
    if (moves) data_q <= full_q ? spare_q : data_i;
    if (~full_q) spare_q <= data_i;
  end

`ifdef FORMAL
  // Numbers as data: each word taken is handed over once, in order, and stays while it waits.
  logic [7:0] taken_q, given_q, held_q;
  logic       waited_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {taken_q, given_q, waited_q} <= '0;
    end else begin
      if (valid_i && ready_o) taken_q <= taken_q + 1'b1;
      if (valid_o && ready_i) given_q <= given_q + 1'b1;
      waited_q <= valid_o && !ready_i;
      held_q <= data_o[7:0];
    end
  end
  initial assume (!rst_ni);
  always_comb begin
    assume (data_i[7:0] == taken_q);
    assert (taken_q == given_q + {7'b0, valid_q} + {7'b0, full_q});
    if (valid_q) assert (data_q[7:0] == given_q);
    if (full_q) assert (valid_q && spare_q[7:0] == given_q + 8'd1);
    if (rst_ni && waited_q) assert (valid_o && data_o[7:0] == held_q);
  end
`endif
endmodule
