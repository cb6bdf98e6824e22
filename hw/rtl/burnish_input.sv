// Input register (RG2): takes the input word, Q1.CosineBits, what is above 1 as 1, and gives one clock later
//   cosine_o   c, Q1.CosineBits
//   versine_o  v = 1 - c, Q0.CosineBits; at c = 0 the largest value below 1
//   zero_o     c = 0
// Clamp and complement stand before the register, where they cost no cell of an FPGA.
module burnish_input #(
  parameter int CosineBits = 15,
  parameter bit Versine    = 0  // 1: the input is v
) (
  input  logic                  clk_i,
  input  logic                  advance_i,
  input  logic [CosineBits:0]   input_i,
  output logic [CosineBits:0]   cosine_o,
  output logic [CosineBits-1:0] versine_o,
  output logic                  zero_o
);
  logic [CosineBits-1:0] low_d, low_q;  // v, or v - 1 where c is given; all ones for c = 0 in both forms
  logic                  one_q, zero_d;

  if (Versine) begin : gen_versine
    logic unused;
    assign low_d = input_i[CosineBits-1:0] | {CosineBits{input_i[CosineBits]}};
    assign zero_d = input_i[CosineBits];
    assign versine_o = low_q;
    assign cosine_o = {1'b0, ~low_q} + {{CosineBits{1'b0}}, ~zero_o};
    assign unused = one_q;
  end else begin : gen_cosine
    assign low_d = ~input_i[CosineBits-1:0] | {CosineBits{input_i[CosineBits]}};
    assign zero_d = ~|input_i;
    assign versine_o = low_q + {{(CosineBits - 1){1'b0}}, ~zero_o};
    assign cosine_o = {one_q, ~low_q};
  end
  burnish_cut #(.Width(CosineBits + 2)) i_register (
    .clk_i, .advance_i, .data_i({low_d, input_i[CosineBits], zero_d}), .data_o({low_q, one_q, zero_o})
  );
endmodule
