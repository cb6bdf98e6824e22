// Splits v = 1 - c, Q0.Bits, at its leading ones: 2^octave v = (2^octave - 1) + rest, rest in [0, 1/2) as
// Q-1.Bits (Bits - 1 bits).
// OctaveBits 4: for octave 15 the rest may be wrong; c is below 2^-14 there. OctaveBits 3: c below 2^-8 gives the
// largest octave and a rest above all others there, and tiny_o tells that c is below 2^-9.
// Latency: 1 with Cut, a register in the middle, 0 without.
module burnish_octave #(
  parameter int Bits       = 15,
  parameter int OctaveBits = 4,  // 3 or 4
  parameter bit Cut        = 0
) (
  input  logic                  clk_i,
  input  logic                  advance_i,
  input  logic [Bits-1:0]       versine_i,
  output logic [OctaveBits-1:0] octave_o,
  output logic [Bits-2:0]       rest_o,
  output logic                  tiny_o
);
  logic [Bits-1:0] after8, after4, after4_q, after2;
  logic            by4, by2, by1, by4_q, first, second, tiny, unused;
  // ones in fours from the top; no bit waits for a shifted one to be tested
  assign first = &versine_i[Bits-1-:4];
  assign second = &versine_i[Bits-5-:4];
  if (OctaveBits == 3) begin : gen_eight
    assign tiny = first & second & versine_i[Bits-9];
    assign by4 = first;
    assign after8 = versine_i;
    assign after4 = ({after8[Bits-5:0], 4'b0} & {Bits{by4}}) | (after8 & {Bits{~by4}}) | {Bits{first & second}};
    assign octave_o = {by4_q, by2, by1};
  end else begin : gen_sixteen
    logic third, by8, by8_q;
    assign third = &versine_i[Bits-9-:4];
    assign by8 = first & second;
    assign by4 = first & (third | ~second);
    assign after8 = {versine_i[Bits-9:0] & {(Bits - 8){by8}}, 8'b0} | (versine_i & {Bits{~by8}});
    assign after4 = {after8[Bits-5:0] & {(Bits - 4){by4}}, 4'b0} | (after8 & {Bits{~by4}});
    burnish_cut #(.Width(1), .Enable(Cut)) i_by8 (.clk_i, .advance_i, .data_i(by8), .data_o(by8_q));
    assign tiny = 1'b0;
    assign octave_o = {by8_q, by4_q, by2, by1};
  end
  burnish_cut #(.Width(Bits + 2), .Enable(Cut)) i_cut (
    .clk_i, .advance_i, .data_i({after4, by4, tiny}), .data_o({after4_q, by4_q, tiny_o})
  );
  assign by2 = &after4_q[Bits-1-:2];
  assign by1 = by2 ? after4_q[Bits-3] : after4_q[Bits-1];
  assign after2 = by2 ? {after4_q[Bits-3:0], 2'b0} : after4_q;
  assign rest_o = by1 ? {after2[Bits-3:0], 1'b0} : after2[Bits-2:0];
  assign unused = after2[Bits-1];
endmodule
