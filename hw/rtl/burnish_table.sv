// Small table in logic: the word at address_i, at once. File: $readmemh image.
// Each word is chosen by itself: synthesis would move a register in front of a memory behind it.
module burnish_table #(
  parameter int AddressBits = 4,
  parameter int Width       = 16,
  parameter int Words       = 2 ** AddressBits,
  parameter     File        = ""
) (
  input  logic [AddressBits-1:0] address_i,
  output logic [Width-1:0]       word_o
);
  logic [Width-1:0] memory [0:Words-1];
  logic [Width-1:0] chosen [0:Words-1];
  initial $readmemh(File, memory);
  for (genvar i = 0; i < Words; i++) begin : gen_word
    localparam int Index = i;
    assign chosen[i] = memory[i] & {Width{address_i == Index[AddressBits-1:0]}};
  end
  always_comb begin
    word_o = '0;
    for (int i = 0; i < Words; i++) word_o |= chosen[i];
  end
endmodule
