// In place of burnish_exp2: what order_exp proves.
module burnish_exp2 #(
  parameter int OutBits      = 8,
  parameter int IndexBits    = 4,
  parameter int Cuts         = 0,
  parameter int FractionBits = OutBits + 2,
  parameter     File         = "exp.mem"
) (
  input  logic                    clk_i,
  input  logic                    advance_i,
  input  logic [FractionBits+3:0] power_i,
  input  logic                    overflow_i,
  output logic [OutBits-1:0]      value_o
);
  logic [OutBits-1:0] fall;
  assign value_o = ~fall;
  ordered #(.KeyBits(FractionBits + 5), .OutBits(OutBits), .Latency($countones(Cuts))) i_ordered (
    .clk_i, .advance_i, .a_i(1'b0), .key_i({overflow_i, power_i | {(FractionBits + 4){overflow_i}}}), .value_o(fall)
  );
endmodule
