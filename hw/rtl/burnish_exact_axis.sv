// burnish_exact between two AXI4-Streams: one question a clock in, one answer a clock out, in order.
//   s_axis_tdata  exponent in bits 9:0, input_i of burnish_exact from bit 16 on, zeros to whole bytes above
//   m_axis_tdata  value_o in the low bits, zeros to whole bytes above
//   tlast, tuser  go along with their question and leave with its answer
// Latency: Depth + 1 clocks where nothing waits. tready and tvalid of both sides come from registers alone: no path
// leads through from m_axis_tready to s_axis_tready.
// A parameter outside its domain ends elaboration. Parameters from LogBits on and the tables' images belong together:
// `burnish hw generate --axis`.
module burnish_exact_axis #(
  parameter int CosineBits   = 15,  // OutBits + 2 to OutBits + 12
  parameter int OutBits      = 8,   // 8 to 12
  parameter bit Versine      = 0,
  parameter int Depth        = 6,   // 3 to 20
  parameter int UserBits     = 1,   // 1 to 64
  parameter int LogBits      = 19,
  parameter int LogIndexBits = 7,
  parameter int LogWordBits  = 16,
  parameter int LogSlopeBits = 0,
  parameter int ExpIndexBits = 4,
  parameter     LogFile      = "log.mem",
  parameter     ExpFile      = "exp.mem",
  localparam int InBits      = 16 + 8 * ((CosineBits + 8) / 8),  // of s_axis_tdata
  localparam int AnswerBits  = 8 * ((OutBits + 7) / 8)           // of m_axis_tdata
) (
  input  logic                  aclk,
  input  logic                  aresetn,
  input  logic                  s_axis_tvalid,
  output logic                  s_axis_tready,
  input  logic [InBits-1:0]     s_axis_tdata,
  input  logic                  s_axis_tlast,
  input  logic [UserBits-1:0]   s_axis_tuser,
  output logic                  m_axis_tvalid,
  input  logic                  m_axis_tready,
  output logic [AnswerBits-1:0] m_axis_tdata,
  output logic                  m_axis_tlast,
  output logic [UserBits-1:0]   m_axis_tuser
);
  // No such modules exist: elaboration stops and names the parameter.
  if (OutBits < 8 || OutBits > 12) begin : gen_out_bits
    error_OutBits_is_8_to_12 i_error ();
  end
  if (CosineBits < 12 || CosineBits < OutBits + 2 || CosineBits > OutBits + 12) begin : gen_cosine_bits
    error_CosineBits_is_OutBits_plus_2_to_12_and_12_at_least i_error ();
  end
  if (Depth < 3 || Depth > 20) begin : gen_depth
    error_Depth_is_3_to_20 i_error ();
  end
  if (UserBits < 1 || UserBits > 64) begin : gen_user_bits
    error_UserBits_is_1_to_64 i_error ();
  end

  localparam int BesideBits = UserBits + 1;
  logic                        valid, ready, unused;
  logic [OutBits-1:0]          value;
  logic [Depth*BesideBits-1:0] beside_q;

  burnish_exact #(
    .CosineBits(CosineBits), .OutBits(OutBits), .Versine(Versine), .Depth(Depth), .LogBits(LogBits),
    .LogIndexBits(LogIndexBits), .LogWordBits(LogWordBits), .LogSlopeBits(LogSlopeBits), .ExpIndexBits(ExpIndexBits),
    .LogFile(LogFile), .ExpFile(ExpFile)
  ) i_exact (
    .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axis_tvalid), .ready_o(s_axis_tready), .exponent_i(s_axis_tdata[9:0]),
    .input_i(s_axis_tdata[16+:CosineBits+1]), .valid_o(valid), .ready_i(ready), .value_o(value)
  );
  // the unit's registers move on the clocks where it is ready
  always_ff @(posedge aclk)
    if (s_axis_tready) beside_q <= {beside_q[(Depth-1)*BesideBits-1:0], s_axis_tlast, s_axis_tuser};

  logic [OutBits-1:0] answer;
  burnish_skid #(.Width(OutBits + BesideBits)) i_skid (
    .clk_i(aclk), .rst_ni(aresetn), .valid_i(valid), .ready_o(ready),
    .data_i({value, beside_q[Depth*BesideBits-1-:BesideBits]}), .valid_o(m_axis_tvalid), .ready_i(m_axis_tready),
    .data_o({answer, m_axis_tlast, m_axis_tuser})
  );
  if (AnswerBits > OutBits) begin : gen_zeros
    assign m_axis_tdata = {{(AnswerBits - OutBits){1'b0}}, answer};
  end else begin : gen_whole
    assign m_axis_tdata = answer;
  end
  assign unused = ^s_axis_tdata;
endmodule
