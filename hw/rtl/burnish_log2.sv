// -log2(1 - rest) for rest in [0, 1/2): Q-1.RestBits+1 in, Q0.LogBits out, below 1 and never falling.
// One table look-up and, with SlopeBits > 0, a product with its slope, added to rest itself; without slopes
// to 1.44312 rest = 23/16 257/256 rest, near rest / ln 2 (the last bit of the 256th is dropped).
// Words of the table: start (and slope, SlopeBits - 1 fraction bits, in the low bits). Starts in the table's
// upper half count in steps of 2^(CoarseShift - LogBits).
// Latency: 1 for the table's register, and one more for each bit of Cuts: bit 0 behind the product or the first
// adders, bit 1 behind the sum.
module burnish_log2 #(
  parameter int RestBits    = 14,
  parameter int LogBits     = 20,
  parameter int IndexBits   = 8,
  parameter int WordBits    = 16,
  parameter int SlopeBits   = 0,
  parameter int CoarseShift = 3,
  parameter int Cuts        = 0,
  parameter     File        = "log.mem"
) (
  input  logic                clk_i,
  input  logic                advance_i,
  input  logic [RestBits-1:0] rest_i,
  output logic [LogBits-1:0]  log_o
);
  localparam int StartBits = WordBits - SlopeBits;
  localparam int Widen     = LogBits - RestBits - 1;  // rest to LogBits
  localparam int LowBits   = RestBits - IndexBits;    // of rest within a cell

  logic [WordBits-1:0] word;
  logic [RestBits-1:0] rest_q;
  logic [LogBits-1:0]  start, first_d, first_q, second_d, second_q;

  burnish_rom #(.AddressBits(IndexBits), .Width(WordBits), .File(File)) i_rom (
    .clk_i, .advance_i, .address_i(rest_i[RestBits-1-:IndexBits]), .word_o(word)
  );
  burnish_cut #(.Width(RestBits)) i_rest (.clk_i, .advance_i, .data_i(rest_i), .data_o(rest_q));

  if (SlopeBits > 0) begin : gen_slope
    localparam int LowProduct = SlopeBits - 1 - Widen;
    logic [SlopeBits+LowBits-1-LowProduct:0] slope;
    logic                                    unused;
    burnish_product #(
      .ABits(LowBits), .BBits(SlopeBits), .Drop(LowProduct), .OutBits(SlopeBits + LowBits - LowProduct), .Saturate(0)
    ) i_product (
      .clk_i, .advance_i, .a_i(rest_q[LowBits-1:0]), .b_i(word[SlopeBits-1:0]), .product_o(slope), .overflow_o(unused)
    );
    assign start = {{(LogBits - StartBits){1'b0}}, word[WordBits-1:SlopeBits]};
    assign first_d = {1'b0, rest_q, {Widen{1'b0}}} + start;
    assign second_d = {{(LogBits - SlopeBits - LowBits + LowProduct){1'b0}}, slope};
  end else begin : gen_linear
    logic [RestBits+4:0] times24, times23;
    assign times24 = {{2'b00, rest_q} + {1'b0, rest_q, 1'b0}, 3'b000};
    assign times23 = times24 - {5'b00000, rest_q};
    if (Widen < 4) begin : gen_narrow
      logic unused;
      assign first_d = times23[RestBits+4:4-Widen];
      assign unused = ^times23[3-Widen:0];
    end else begin : gen_wide
      assign first_d = {times23, {(Widen - 4){1'b0}}};
    end
    assign start = {{(LogBits - StartBits){1'b0}}, word} << (rest_q[RestBits-1] ? CoarseShift : 0);
    assign second_d = start;
  end

  burnish_cut #(.Width(2 * LogBits), .Enable(Cuts[0])) i_first (
    .clk_i, .advance_i, .data_i({first_d, second_d}), .data_o({first_q, second_q})
  );
  logic [LogBits-1:0] log;
  if (SlopeBits > 0) begin : gen_sum
    assign log = first_q + second_q;
  end else begin : gen_linear_sum
    logic [LogBits-2:0] rest_part;  // separate adders with a carry chain each
    assign rest_part = {8'b0, first_q[LogBits-1:9]} + second_q[LogBits-1:1];
    assign log = first_q + {rest_part, second_q[0]};
  end
  burnish_cut #(.Width(LogBits), .Enable(Cuts[1])) i_log (.clk_i, .advance_i, .data_i(log), .data_o(log_o));
endmodule
