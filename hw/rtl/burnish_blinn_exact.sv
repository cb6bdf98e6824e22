// Blinn's highlight from vectors to value: burnish_blinn feeding burnish_exact through v = 1 - c.
//   normal_i, light_i, view_i  three components, x in the low bits, each S1.16 in 18 bits
//   exponent_i                 U10.0, 1 to 1023
//   value_o                    c^exponent (2^OutBits - 1), c = n.h / (|n| |h|), clamped at 0
// One value a clock, valid/ready on both sides. Latency: 12 + Depth clocks.
module burnish_blinn_exact #(
  parameter int VersineBits  = 20,
  parameter int OutBits      = 8,
  parameter int Depth        = 6,
  parameter int LogBits      = 20,
  parameter int LogIndexBits = 7,
  parameter int LogWordBits  = 16,
  parameter int LogSlopeBits = 0,
  parameter int ExpIndexBits = 4,
  parameter     RsqrtFile    = "rsqrt.mem",
  parameter     LogFile      = "log.mem",
  parameter     ExpFile      = "exp.mem"
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               valid_i,
  output logic               ready_o,
  input  logic [53:0]        normal_i,
  input  logic [53:0]        light_i,
  input  logic [53:0]        view_i,
  input  logic [9:0]         exponent_i,
  output logic               valid_o,
  input  logic               ready_i,
  output logic [OutBits-1:0] value_o
);
  logic                 valid, ready;
  logic [VersineBits:0] versine;
  logic [9:0]           exponent;

  burnish_blinn #(.VersineBits(VersineBits), .RsqrtFile(RsqrtFile)) i_blinn (
    .clk_i, .rst_ni, .valid_i, .ready_o, .normal_i, .light_i, .view_i, .exponent_i,
    .valid_o(valid), .ready_i(ready), .versine_o(versine), .exponent_o(exponent)
  );
  burnish_exact #(
    .CosineBits(VersineBits), .OutBits(OutBits), .Versine(1), .Depth(Depth), .LogBits(LogBits),
    .LogIndexBits(LogIndexBits), .LogWordBits(LogWordBits), .LogSlopeBits(LogSlopeBits), .ExpIndexBits(ExpIndexBits),
    .LogFile(LogFile), .ExpFile(ExpFile)
  ) i_exact (
    .clk_i, .rst_ni, .valid_i(valid), .ready_o(ready), .exponent_i(exponent), .input_i(versine),
    .valid_o, .ready_i, .value_o
  );
endmodule
