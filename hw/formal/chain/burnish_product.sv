// In place of burnish_product: what order_product proves.
module burnish_product #(
  parameter int ABits    = 10,
  parameter int BBits    = 22,
  parameter int Drop     = 9,
  parameter int OutBits  = 14,
  parameter bit Saturate = 1,
  parameter int Cuts     = 0
) (
  input  logic               clk_i,
  input  logic               advance_i,
  input  logic [ABits-1:0]   a_i,
  input  logic [BBits-1:0]   b_i,
  output logic [OutBits-1:0] product_o,
  output logic               overflow_o
);
  // the product of an overflow is meaningless
  (* anyseq *) logic [OutBits-1:0] any;
  logic [OutBits-1:0]              product;
  ordered #(.ABits(ABits), .KeyBits(BBits), .OutBits(OutBits + 1), .Latency($countones(Cuts))) i_ordered (
    .clk_i, .advance_i, .a_i, .key_i(b_i), .value_o({overflow_o, product})
  );
  assign product_o = overflow_o ? any : product;
endmodule
