// z / 2^FractionBits in [0, 1] as a whole number of 1 / (2^OutBits - 1), rounded: exact at 0 and 1, never
// falling. FractionBits - OutBits must be less than OutBits. Combinational.
module burnish_scale #(
  parameter int FractionBits = 12,
  parameter int OutBits      = 8
) (
  input  logic [FractionBits:0] z_i,
  output logic [OutBits-1:0]    value_o
);
  localparam int Guard = FractionBits - OutBits;

  logic [Guard+1:0]      offset;  // half a step - z / 2^OutBits, signed
  logic [FractionBits:0] sum;
  logic                  unused;
  assign offset = {3'b001, {(Guard - 1){1'b0}}} - {1'b0, z_i[FractionBits:OutBits]};
  assign sum = z_i + {{(OutBits - 1){offset[Guard+1]}}, offset};
  assign value_o = sum[FractionBits-1:Guard];
  assign unused = ^{sum[FractionBits], sum[Guard-1:0]};
endmodule
