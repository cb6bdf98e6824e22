// Small table in logic: the word at address_i, at once. File: $readmemh image.
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
  initial $readmemh(File, memory);
  assign word_o = memory[address_i];
endmodule
