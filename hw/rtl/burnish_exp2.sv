// round((2^OutBits - 1) 2^-p) to within 1, 2^OutBits - 1 at p = 0, never rising; p is Q4.FractionBits,
// FractionBits = OutBits + 2, and overflow_i stands for any p of 16 and more.
// A table with slopes holds one octave, the whole part of p shifts.
// Words of the table: start in steps of 2^-MantissaBits, fall over the cell in the low bits.
// Latency: the number of bits set in Cuts: bit 0 behind the multiples of the slope, 1 behind the product, 2 behind the
// difference, 3 behind the shift, 4 within the product, 5 behind the table's word.
module burnish_exp2 #(
  parameter int OutBits      = 8,
  parameter int IndexBits    = 4,
  parameter int Cuts         = 0,
  parameter int FractionBits = OutBits + 2,
  parameter     File         = "exp.mem"
) (
  input  logic                  clk_i,
  input  logic                  advance_i,
  input  logic [FractionBits+3:0] power_i,
  input  logic                  overflow_i,
  output logic [OutBits-1:0]    value_o
);
  localparam int MantissaBits = OutBits + 3;
  localparam int SlopeBits    = MantissaBits - IndexBits;
  localparam int LowBits      = FractionBits - IndexBits;
  localparam int Levels       = $clog2(LowBits / 2 + 1);  // of the product's adders

  logic [MantissaBits+SlopeBits-1:0] word_t, word;
  logic [FractionBits+4:0] power;  // with overflow_i above
  logic [MantissaBits-1:0] start_w, start_q, start_qq, mantissa, mantissa_q;
  logic [SlopeBits-1:0]    fall, fall_q;
  logic [4:0]              whole_w, whole_q, whole_qq, whole_qqq;  // with overflow_i above
  logic [OutBits:0]        shifted, shifted_q, rounded;
  logic                    unused, unused_overflow;

  burnish_table #(.AddressBits(IndexBits), .Width(MantissaBits + SlopeBits), .File(File)) i_table (
    .address_i(power_i[FractionBits-1-:IndexBits]), .word_o(word_t)
  );
  burnish_cut #(.Width(MantissaBits + SlopeBits + FractionBits + 5), .Enable(Cuts[5])) i_table_cut (
    .clk_i, .advance_i, .data_i({word_t, overflow_i, power_i}), .data_o({word, power})
  );
  burnish_product #(
    .ABits(LowBits), .BBits(SlopeBits), .Drop(LowBits), .OutBits(SlopeBits), .Saturate(0),
    .Cuts((Cuts[0] ? 1 : 0) | (Cuts[4] ? 2 ** (Levels - 1) : 0))
  ) i_product (
    .clk_i, .advance_i, .a_i(power[LowBits-1:0]), .b_i(word[SlopeBits-1:0]), .product_o(fall),
    .overflow_o(unused_overflow)
  );
  burnish_cut #(.Width(MantissaBits + 5), .Enable(Cuts[0])) i_word (
    .clk_i, .advance_i, .data_i({word[MantissaBits+SlopeBits-1:SlopeBits], power[FractionBits+:5]}),
    .data_o({start_w, whole_w})
  );
  burnish_cut #(.Width(MantissaBits + 5), .Enable(Cuts[4])) i_inside (
    .clk_i, .advance_i, .data_i({start_w, whole_w}), .data_o({start_q, whole_q})
  );
  burnish_cut #(.Width(MantissaBits + SlopeBits + 5), .Enable(Cuts[1])) i_fall (
    .clk_i, .advance_i, .data_i({start_q, fall, whole_q}), .data_o({start_qq, fall_q, whole_qq})
  );
  assign mantissa = start_qq - {{IndexBits{1'b0}}, fall_q};
  burnish_cut #(.Width(MantissaBits + 5), .Enable(Cuts[2])) i_mantissa (
    .clk_i, .advance_i, .data_i({mantissa, whole_qq}), .data_o({mantissa_q, whole_qqq})
  );
  assign shifted = whole_qqq[4] ? '0 : mantissa_q[MantissaBits-1:2] >> whole_qqq[3:0];
  burnish_cut #(.Width(OutBits + 1), .Enable(Cuts[3])) i_shifted (
    .clk_i, .advance_i, .data_i(shifted), .data_o(shifted_q)
  );
  assign rounded = shifted_q + 1'b1;
  assign value_o = rounded[OutBits:1];
  assign unused = ^{mantissa_q[1:0], rounded[0], power[FractionBits-1:LowBits]};
endmodule
