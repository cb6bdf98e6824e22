// The exact unit between AXI4-Streams, any pauses on both sides: only c = 0 and c = 1 are offered. The answer to any
// one question, chosen by its number, is its own and comes with its own tlast and tuser. An answer that waits stays as
// it is.
module axis #(
  parameter int         Depth    = 3,
  parameter logic [9:0] Exponent = 10'd1023
) (
  input logic       clk_i,
  input logic       valid_i,
  input logic       ready_i,
  input logic       one_i,
  input logic       last_i,
  input logic [1:0] user_i
);
  (* anyconst *) logic [3:0] number;
  logic        rst_n_q = 1'b0, ready, valid, last, seen_q = 1'b0, one_q, last_q, waits_q = 1'b0;
  logic [3:0]  taken_q = '0, given_q = '0;
  logic [7:0]  value;
  logic [1:0]  user, user_q;
  logic [10:0] answer_q;

  burnish_exact_axis #(.Depth(Depth), .UserBits(2)) i_unit (
    .aclk(clk_i), .aresetn(rst_n_q), .s_axis_tvalid(valid_i), .s_axis_tready(ready),
    .s_axis_tdata({one_i, 15'b0, 6'b0, Exponent}), .s_axis_tlast(last_i), .s_axis_tuser(user_i), .m_axis_tvalid(valid),
    .m_axis_tready(ready_i), .m_axis_tdata(value), .m_axis_tlast(last), .m_axis_tuser(user)
  );

  always_ff @(posedge clk_i) begin
    rst_n_q <= 1'b1;
    assume (taken_q != '1);
    if (rst_n_q) begin
      waits_q <= valid && !ready_i;
      answer_q <= {value, last, user};
      if (waits_q) assert (valid && answer_q == {value, last, user});
      if (valid_i && ready) begin
        taken_q <= taken_q + 1'b1;
        if (taken_q == number) {seen_q, one_q, last_q, user_q} <= {1'b1, one_i, last_i, user_i};
      end
      if (valid && ready_i) given_q <= given_q + 1'b1;
      if (valid) begin
        assert (taken_q != given_q);
        if (given_q == number) assert (seen_q && value == {8{one_q}} && last == last_q && user == user_q);
      end
    end
  end
endmodule
