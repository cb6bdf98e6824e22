// -log2(1 - rest) for rest in [0, 1/2): Q-1.RestBits+1 in, Q0.LogBits out, below 1 and never falling.
// With SlopeBits > 0: one table look-up and a product with its slope, added to rest itself. Words of the table: start,
// and slope in the low bits (SlopeBits - 1 fraction bits).
// Without slopes: the sum of 2 rest, a word of the table, (largest - low) 72/128 and low / 128. Here low has the low
// bits of rest within a cell, and largest is their largest value. So the slope within a cell is 185/128, near 1/ln 2.
// Words of the table: start, negative, without its leading ones, in steps of 2^(WordBits + 3 - LogBits) of the last
// place.
// Latency: 1 for the table's register, and one more for each bit of Cuts: bit 0 behind the product or the first
// adders, bit 1 behind the sum, bit 2 behind the table's word, bit 3 within the product or the sum.
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
  localparam int StartBits = WordBits - SlopeBits;
  localparam int Widen     = LogBits - RestBits - 1;  // rest to LogBits
  localparam int LowBits   = RestBits - IndexBits;    // of rest within a cell

  logic [WordBits-1:0] word_t, word;
  logic [RestBits-1:0] rest_t, rest_q;
  logic [LogBits-1:0]  first_d, first_q, second_d, second_q;

  burnish_rom #(.AddressBits(IndexBits), .Width(WordBits), .File(File)) i_rom (
    .clk_i, .advance_i, .address_i(rest_i[RestBits-1-:IndexBits]), .word_o(word_t)
  );
  burnish_cut #(.Width(RestBits)) i_rest (.clk_i, .advance_i, .data_i(rest_i), .data_o(rest_t));
  burnish_cut #(.Width(WordBits + RestBits), .Enable(Cuts[2])) i_word (
    .clk_i, .advance_i, .data_i({word_t, rest_t}), .data_o({word, rest_q})
  );

  if (SlopeBits > 0) begin : gen_slope
    localparam int LowProduct = SlopeBits - 1 - Widen;
    logic [SlopeBits+LowBits-1-LowProduct:0] slope;
    logic                                    unused;
    burnish_product #(
      .ABits(LowBits), .BBits(SlopeBits), .Drop(LowProduct), .OutBits(SlopeBits + LowBits - LowProduct), .Saturate(0),
      .Cuts(Cuts[3] ? 1 : 0)
    ) i_product (
      .clk_i, .advance_i, .a_i(rest_q[LowBits-1:0]), .b_i(word[SlopeBits-1:0]), .product_o(slope), .overflow_o(unused)
    );
    burnish_cut #(.Width(LogBits), .Enable(Cuts[3])) i_start (
      .clk_i, .advance_i,
      .data_i({1'b0, rest_q, {Widen{1'b0}}} + {{(LogBits - StartBits){1'b0}}, word[WordBits-1:SlopeBits]}),
      .data_o(first_d)
    );
    assign second_d = {{(LogBits - SlopeBits - LowBits + LowProduct){1'b0}}, slope};
  end else begin : gen_linear
    localparam int Steps = LogBits - 3 - WordBits;
    logic [LowBits-1:0] low;
    logic [LowBits-1:0] low_t;
    logic [LowBits+3:0] ninth_t, ninth;  // 8 (largest - low) + low
    logic [LowBits+6:0] times;  // 128 times what is added
    assign low = rest_q[LowBits-1:0];
    assign low_t = rest_t[LowBits-1:0];
    assign ninth_t = {1'b0, ~low_t, 3'b000} + {4'b0000, low_t};
    burnish_cut #(.Width(LowBits + 4), .Enable(Cuts[2])) i_ninth (
      .clk_i, .advance_i, .data_i(ninth_t), .data_o(ninth)
    );
    assign times = {1'b0, ~low, 6'b000000} + {3'b000, ninth};
    if (Widen < 7) begin : gen_narrow
      logic unused;
      assign second_d = {{(LogBits - LowBits - Widen){1'b0}}, times[LowBits+6:7-Widen]};
      assign unused = ^times[6-Widen:0];
    end else begin : gen_wide
      assign second_d = {{(LogBits - LowBits - 7){1'b0}}, times} << (Widen - 7);
    end
    assign first_d = {rest_q, {(Widen + 1){1'b0}}} + {3'b111, word, {Steps{1'b0}}};
  end

  burnish_cut #(.Width(2 * LogBits), .Enable(Cuts[0])) i_first (
    .clk_i, .advance_i, .data_i({first_d, second_d}), .data_o({first_q, second_q})
  );
  logic [LogBits-1:0] log;
  if (SlopeBits == 0 && Cuts[3]) begin : gen_halves
    localparam int Half = LogBits / 2;
    logic [Half:0]               low, low_q;
    logic [2*(LogBits-Half)-1:0] high_q;
    assign low = {1'b0, first_q[Half-1:0]} + {1'b0, second_q[Half-1:0]};
    burnish_cut #(.Width(2 * LogBits - Half + 1)) i_half (
      .clk_i, .advance_i, .data_i({low, first_q[LogBits-1:Half], second_q[LogBits-1:Half]}), .data_o({low_q, high_q})
    );
    assign log[Half-1:0] = low_q[Half-1:0];
    assign log[LogBits-1:Half] = high_q[2*(LogBits-Half)-1:LogBits-Half] + high_q[LogBits-Half-1:0]
                               + {{(LogBits - Half - 1){1'b0}}, low_q[Half]};
  end else begin : gen_sum
    assign log = first_q + second_q;
  end
  burnish_cut #(.Width(LogBits), .Enable(Cuts[1])) i_log (.clk_i, .advance_i, .data_i(log), .data_o(log_o));
endmodule
