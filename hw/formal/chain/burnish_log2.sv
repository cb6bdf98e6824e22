// In place of burnish_log2: what order_log proves.
module burnish_log2 #(
  parameter int RestBits  = 14,
  parameter int LogBits   = 19,
  parameter int IndexBits = 7,
  parameter int WordBits  = 16,
  parameter int SlopeBits = 0,
  parameter int Cuts      = 0,
  parameter     File      = "log.mem"
) (
  input  logic                clk_i,
  input  logic                advance_i,
  input  logic [RestBits-1:0] rest_i,
  output logic [LogBits-1:0]  log_o
);
  ordered #(.KeyBits(RestBits), .OutBits(LogBits), .Latency(1 + $countones(Cuts))) i_ordered (
    .clk_i, .advance_i, .a_i(1'b0), .key_i(rest_i), .value_o(log_o)
  );
endmodule
