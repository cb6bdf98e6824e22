// x in [0, 1] with From fraction bits, cut or widened to To. Combinational.
module burnish_rescale #(
  parameter int From = 15,
  parameter int To   = 12
) (
  input  logic [From:0] x_i,
  output logic [To:0]   x_o
);
  if (To > From) begin : gen_widen
    assign x_o = {x_i, {(To - From){1'b0}}};
  end else begin : gen_cut
    logic unused;
    assign x_o = x_i[From-:To+1];
    assign unused = ^x_i;
  end
endmodule
