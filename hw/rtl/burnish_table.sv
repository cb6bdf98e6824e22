// Small table in logic: the word at address_i, at once. File: $readmemh image.
// The table lies in reverse, so that an inverter parts it from a register in front: synthesis would else make the
// register one of a synchronous memory and move it behind the table.
module burnish_table #(
  parameter int AddressBits = 4,
  parameter int Width       = 16,
  parameter int Words       = 2 ** AddressBits,
  parameter     File        = ""
) (
  input  logic [AddressBits-1:0] address_i,
  output logic [Width-1:0]       word_o
);
  localparam int Last = 2 ** AddressBits - 1;
  logic [Width-1:0] memory [Last + 1 - Words:Last];
  initial $readmemh(File, memory, Last, Last + 1 - Words);
  assign word_o = memory[~address_i];
endmodule
