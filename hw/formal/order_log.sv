// u = octave - log2(1 - rest) never falls as v rises, is 0 at v = 0 and 15 or more at the largest v.
module order_log #(
  parameter int CosineBits  = 15,
  parameter int LogBits     = 20,
  parameter int IndexBits   = 8,
  parameter int WordBits    = 16,
  parameter int SlopeBits   = 0,
  parameter int CoarseShift = 3,
  parameter     File        = "log.mem"
) (
  input logic                  clk_i,
  input logic [CosineBits-1:0] versine_i
);
  logic [CosineBits-1:0] versine_a, versine_b;
  logic [LogBits+3:0]    log_a, log_b;
  logic                  started_q = 1'b0;
  logic [CosineBits-1:0] versine_q = '0;

  logic [3:0]            octave_a, octave_b;
  logic [CosineBits-2:0] rest_a, rest_b;

  assign versine_a = versine_i;
  assign versine_b = versine_i + 1'b1;
  burnish_octave #(.Bits(CosineBits)) i_octave_a (
    .clk_i, .advance_i(1'b1), .versine_i(versine_a), .octave_o(octave_a), .rest_o(rest_a)
  );
  burnish_cut #(.Width(4)) i_cut_a (.clk_i, .advance_i(1'b1), .data_i(octave_a), .data_o(log_a[LogBits+:4]));
  burnish_log2 #(
    .RestBits(CosineBits - 1), .LogBits(LogBits), .IndexBits(IndexBits), .WordBits(WordBits),
    .SlopeBits(SlopeBits), .CoarseShift(CoarseShift), .File(File)
  ) i_log_a (
    .clk_i, .advance_i(1'b1), .rest_i(rest_a), .log_o(log_a[LogBits-1:0])
  );
  burnish_octave #(.Bits(CosineBits)) i_octave_b (
    .clk_i, .advance_i(1'b1), .versine_i(versine_b), .octave_o(octave_b), .rest_o(rest_b)
  );
  burnish_cut #(.Width(4)) i_cut_b (.clk_i, .advance_i(1'b1), .data_i(octave_b), .data_o(log_b[LogBits+:4]));
  burnish_log2 #(
    .RestBits(CosineBits - 1), .LogBits(LogBits), .IndexBits(IndexBits), .WordBits(WordBits),
    .SlopeBits(SlopeBits), .CoarseShift(CoarseShift), .File(File)
  ) i_log_b (
    .clk_i, .advance_i(1'b1), .rest_i(rest_b), .log_o(log_b[LogBits-1:0])
  );

  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    versine_q <= versine_i;
    assume (versine_i != {CosineBits{1'b1}});
    if (started_q) begin
      assert (log_a <= log_b);
      if (versine_q == '0) assert (log_a == '0);
      if (versine_q == {{(CosineBits - 1){1'b1}}, 1'b0}) assert (log_b >= {4'd12, {LogBits{1'b0}}});
    end
  end
endmodule
