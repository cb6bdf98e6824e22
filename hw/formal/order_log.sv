// u = -log2 c never rises with c; it is 0 at c = 1 and 12 or more at c = 0.
module order_log #(
  parameter int CosineBits = 15,
  parameter int LogBits    = 20
) (
  input logic                clk_i,
  input logic [CosineBits:0] cosine_i
);
  localparam logic [CosineBits:0] One = {1'b1, {CosineBits{1'b0}}};
  logic [LogBits+3:0]  log [0:1];
  logic [1:0]          started_q = '0;
  logic [CosineBits:0] cosine_q, cosine_qq;

  for (genvar i = 0; i < 2; i++) begin : gen_unit  // c and its neighbour
    logic [CosineBits:0]   cosine, unused_cosine;
    logic [CosineBits-1:0] versine;
    logic [CosineBits-2:0] rest;
    logic [3:0]            octave;
    logic                  unused_zero;
    assign cosine = cosine_i + i;
    burnish_input #(.CosineBits(CosineBits)) i_input (
      .clk_i, .advance_i(1'b1), .input_i(cosine), .cosine_o(unused_cosine), .versine_o(versine), .zero_o(unused_zero)
    );
    burnish_octave #(.Bits(CosineBits)) i_octave (
      .clk_i, .advance_i(1'b1), .versine_i(versine), .octave_o(octave), .rest_o(rest)
    );
    burnish_cut #(.Width(4)) i_cut (.clk_i, .advance_i(1'b1), .data_i(octave), .data_o(log[i][LogBits+:4]));
    burnish_log2 #(.RestBits(CosineBits - 1), .LogBits(LogBits)) i_log (
      .clk_i, .advance_i(1'b1), .rest_i(rest), .log_o(log[i][LogBits-1:0])
    );
  end

  always_ff @(posedge clk_i) begin
    started_q <= {started_q[0], 1'b1};
    {cosine_q, cosine_qq} <= {cosine_i, cosine_q};
  end
  always_comb begin
    assume (cosine_i != '1);
    if (started_q[1]) begin
      assert (log[1] <= log[0]);
      if (cosine_qq == '0) assert (log[0][LogBits+:4] >= 4'd12);
      if (cosine_qq >= One) assert (log[0] == '0);
    end
  end
endmodule
