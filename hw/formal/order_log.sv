// -log2(1 - r) never falls with r.
module order_log #(
  parameter int RestBits = 14,
  parameter int LogBits  = 19
) (
  input logic                clk_i,
  input logic [RestBits-1:0] rest_i
);
  logic [RestBits-1:0] rest_next;
  logic [LogBits-1:0]  log, log_next;
  logic                started_q = 1'b0;

  assign rest_next = rest_i + 1'b1;
  burnish_log2 #(.RestBits(RestBits), .LogBits(LogBits)) i_log (
    .clk_i, .advance_i(1'b1), .rest_i, .log_o(log)
  );
  burnish_log2 #(.RestBits(RestBits), .LogBits(LogBits)) i_next (
    .clk_i, .advance_i(1'b1), .rest_i(rest_next), .log_o(log_next)
  );

  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb begin
    assume (rest_i != '1);
    if (started_q) assert (log <= log_next);
  end
endmodule
