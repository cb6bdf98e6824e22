// Splits v = 1 - c, Q0.Bits, at its leading ones: 2^octave v = (2^octave - 1) + rest, rest in [0, 1/2) as
// Q-1.Bits (Bits - 1 bits). For octave 15 the rest may be wrong; c is below 2^-14 there.
// Latency: 1 with Cut, a register in the middle, 0 without.
module burnish_octave #(
  parameter int Bits = 15,
  parameter bit Cut  = 0
) (
  input  logic            clk_i,
  input  logic            advance_i,
  input  logic [Bits-1:0] versine_i,
  output logic [3:0]      octave_o,
  output logic [Bits-2:0] rest_o
);
  logic [Bits-1:0] after8, after4, after4_q, after2;
  logic            by8, by4, by2, by1, by8_q, by4_q, first, second, third, unused;
  // ones in fours from the top; no bit waits for a shifted one to be tested
  assign first = &versine_i[Bits-1-:4];
  assign second = &versine_i[Bits-5-:4];
  assign third = &versine_i[Bits-9-:4];
  assign by8 = first & second;
  assign by4 = first & (third | ~second);
  assign after8 = {versine_i[Bits-9:0] & {(Bits - 8){by8}}, 8'b0} | (versine_i & {Bits{~by8}});
  assign after4 = {after8[Bits-5:0] & {(Bits - 4){by4}}, 4'b0} | (after8 & {Bits{~by4}});
  burnish_cut #(.Width(Bits + 2), .Enable(Cut)) i_cut (
    .clk_i, .advance_i, .data_i({after4, by8, by4}), .data_o({after4_q, by8_q, by4_q})
  );
  assign by2 = &after4_q[Bits-1-:2];
  assign by1 = by2 ? after4_q[Bits-3] : after4_q[Bits-1];
  assign after2 = by2 ? {after4_q[Bits-3:0], 2'b0} : after4_q;
  assign rest_o = by1 ? {after2[Bits-3:0], 1'b0} : after2[Bits-2:0];
  assign octave_o = {by8_q, by4_q, by2, by1};
  assign unused = after2[Bits-1];
endmodule
