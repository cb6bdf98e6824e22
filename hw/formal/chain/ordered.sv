// What is known of a stage once its order is proved: some value for each question, at or above the last question's
// where key_i is at or above the last one's and a_i the same. Latency: Latency clocks.
module ordered #(
  parameter int ABits    = 1,
  parameter int KeyBits  = 8,
  parameter int OutBits  = 8,
  parameter int Latency  = 0
) (
  input  logic               clk_i,
  input  logic               advance_i,
  input  logic [ABits-1:0]   a_i,
  input  logic [KeyBits-1:0] key_i,
  output logic [OutBits-1:0] value_o
);
  (* anyseq *) logic [OutBits-1:0] value;
  logic [ABits-1:0]                a_q;
  logic [KeyBits-1:0]              key_q;
  logic [OutBits-1:0]              value_q;
  logic                            started_q = 1'b0;
  always_ff @(posedge clk_i) if (advance_i) {a_q, key_q, value_q, started_q} <= {a_i, key_i, value, 1'b1};
  always_comb if (started_q && a_i == a_q && key_i >= key_q) assume (value >= value_q);

  logic [OutBits*(Latency+1)-1:0] values;
  assign values[OutBits-1:0] = value;
  for (genvar i = 0; i < Latency; i++) begin : gen_latency
    burnish_cut #(.Width(OutBits)) i_cut (
      .clk_i, .advance_i, .data_i(values[OutBits*i+:OutBits]), .data_o(values[OutBits*(i+1)+:OutBits])
    );
  end
  assign value_o = values[OutBits*Latency+:OutBits];
endmodule
