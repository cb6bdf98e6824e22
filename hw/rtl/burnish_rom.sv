// Table with a registered output, a block RAM: the word at address_i, one clock later. File: $readmemh image.
module burnish_rom #(
  parameter int AddressBits = 8,
  parameter int Width       = 16,
  parameter int Words       = 2 ** AddressBits,
  parameter     File        = ""
) (
  input  logic                   clk_i,
  input  logic                   advance_i,
  input  logic [AddressBits-1:0] address_i,
  output logic [Width-1:0]       word_o
);
  logic [Width-1:0] memory [0:Words-1];
  initial $readmemh(File, memory);
  always_ff @(posedge clk_i) if (advance_i) word_o <= memory[address_i];
endmodule
