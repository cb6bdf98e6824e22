// floor(2^FractionBits n / d) for n <= d, d > 0: restoring division, one bit of the quotient a row.
// Latency: Cuts clocks, registers spread evenly between the FractionBits + 1 rows.
module burnish_divider #(
  parameter int Width        = 26,
  parameter int FractionBits = 10,
  parameter int Cuts         = 0  // at most FractionBits
) (
  input  logic                  clk_i,
  input  logic                  advance_i,
  input  logic [Width-1:0]      numerator_i,
  input  logic [Width-1:0]      denominator_i,
  output logic [FractionBits:0] quotient_o
);
  for (genvar row = 0; row <= FractionBits; row++) begin : gen_row
    localparam bit Cut = row < FractionBits && (row + 1) * Cuts / FractionBits > row * Cuts / FractionBits;
    logic [Width-1:0]      remainder, denominator, rest, next_remainder, next_denominator;
    logic [Width:0]        trial;
    logic [FractionBits:0] quotient, next_quotient, bits;
    logic                  unused;
    if (row == 0) begin : gen_first
      assign {remainder, denominator, quotient} = {numerator_i, denominator_i, {(FractionBits + 1){1'b0}}};
    end else begin : gen_next
      assign remainder = {gen_row[row-1].next_remainder[Width-2:0], 1'b0};
      assign denominator = gen_row[row-1].next_denominator;
      assign quotient = gen_row[row-1].next_quotient;
    end
    assign trial = {1'b0, remainder} - {1'b0, denominator};
    assign rest = trial[Width] ? remainder : trial[Width-1:0];
    assign unused = ^{quotient, next_remainder, next_denominator};
    assign bits = {quotient[FractionBits-1:0], ~trial[Width]};
    burnish_cut #(.Width(2 * Width + FractionBits + 1), .Enable(Cut)) i_cut (
      .clk_i, .advance_i, .data_i({rest, denominator, bits}), .data_o({next_remainder, next_denominator, next_quotient})
    );
  end
  assign quotient_o = gen_row[FractionBits].next_quotient;
endmodule
