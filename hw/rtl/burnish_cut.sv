// A pipeline register where Enable is 1, a wire where it is 0.
module burnish_cut #(
  parameter int Width  = 1,
  parameter bit Enable = 1
) (
  input  logic             clk_i,
  input  logic             advance_i,
  input  logic [Width-1:0] data_i,
  output logic [Width-1:0] data_o
);
  if (Enable) begin : gen_register
    logic [Width-1:0] data_q;
    always_ff @(posedge clk_i) if (advance_i) data_q <= data_i;
    assign data_o = data_q;
  end else begin : gen_wire
    logic unused;
    assign unused = ^{clk_i, advance_i};
    assign data_o = data_i;
  end
endmodule
