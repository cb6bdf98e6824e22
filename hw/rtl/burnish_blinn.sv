// Blinn's front end: v = 1 - n.h / (|n| |h|), h = light + view, from vectors of any length up to 2, so that
// interpolated normals need no normalizing before. Feeds a unit with Versine.
//   normal_i, light_i, view_i  three components, x in the low bits, each S1.16 in 18 bits
//   exponent_i, exponent_o     U10.0, carried along
//   versine_o                  Q1.VersineBits in [0, 1]: 0 where light = -view, 1 where the cosine is not above 0
// Error for |n| and |h| of 1/2 and more: half a step and 2^-22, beside the vectors' own rounding.
// 1/sqrt(|n|^2 |h|^2) by a table with slopes and one step of Newton. 20 multipliers, for devices with DSP blocks.
// One value a clock, valid/ready on both sides. Latency: 12 clocks.
// RsqrtFile: `burnish hw generate --blinn`.
module burnish_blinn #(
  parameter int VersineBits = 20,  // 12 to 24
  parameter     RsqrtFile   = "rsqrt.mem"
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 valid_i,
  output logic                 ready_o,
  input  logic [53:0]          normal_i,
  input  logic [53:0]          light_i,
  input  logic [53:0]          view_i,
  input  logic [9:0]           exponent_i,
  output logic                 valid_o,
  input  logic                 ready_i,
  output logic [VersineBits:0] versine_o,
  output logic [9:0]           exponent_o
);
  localparam int Depth = 12;
  localparam logic [VersineBits:0] One = {1'b1, {VersineBits{1'b0}}};

  logic advance;
  burnish_flow #(.Depth(Depth)) i_flow (
    .clk_i, .rst_ni, .valid_i, .ready_o, .valid_o, .ready_i, .advance_o(advance)
  );

  logic [10*Depth-1:0] exponents_q;
  always_ff @(posedge clk_i) if (advance) exponents_q <= {exponents_q[10*Depth-11:0], exponent_i};
  assign exponent_o = exponents_q[10*Depth-1-:10];

  // 1: half vector; 2: products; 3: sums
  logic signed [37:0] nn_q, hh_q, nh_q;
  for (genvar i = 0; i < 3; i++) begin : gen_axis
    logic signed [17:0] n_q, light, view;
    logic signed [18:0] h_q;
    logic signed [37:0] nn_part_q, hh_part_q, nh_part_q;
    assign light = light_i[18*i+:18];
    assign view = view_i[18*i+:18];
    always_ff @(posedge clk_i) if (advance) begin
      n_q <= normal_i[18*i+:18];
      h_q <= light + view;
      nn_part_q <= n_q * n_q;
      hh_part_q <= h_q * h_q;
      nh_part_q <= n_q * h_q;
    end
  end
  always_ff @(posedge clk_i) if (advance) begin
    nn_q <= gen_axis[0].nn_part_q + gen_axis[1].nn_part_q + gen_axis[2].nn_part_q;
    hh_q <= gen_axis[0].hh_part_q + gen_axis[1].hh_part_q + gen_axis[2].hh_part_q;
    nh_q <= gen_axis[0].nh_part_q + gen_axis[1].nh_part_q + gen_axis[2].nh_part_q;
  end

  // 4: |n|^2 |h|^2, 48 fraction bits
  logic        [57:0] q_q;
  logic signed [37:0] nh4_q, nh5_q;
  always_ff @(posedge clk_i) if (advance) begin
    q_q <= {30'b0, nn_q[35:8]} * {28'b0, hh_q[37:8]};
    nh4_q <= nh_q;
  end

  // 5: as m 4^k, m in [1, 4) with 24 fraction bits
  logic [4:0]  k, k_q;
  logic [25:0] m_q, m6_q, m7_q, m8_q;
  logic [57:0] aligned;
  logic        none_q, full_q;  // h = 0; cosine <= 0
  always_comb begin
    k = '0;
    for (int i = 0; i < 29; i++) if (q_q[2*i] | q_q[2*i+1]) k = i[4:0];
  end
  assign aligned = q_q << {5'd28 - k, 1'b0};
  always_ff @(posedge clk_i) if (advance) begin
    k_q <= k;
    m_q <= aligned[57:32];
    nh5_q <= nh4_q;
    none_q <= q_q == '0;
    full_q <= q_q != '0 && nh4_q <= 0;
  end

  // 6: table; n.h 2^(24 - k) with 26 fraction bits
  logic [27:0] word;
  logic [28:0] scaled6_q, scaled7_q, scaled8_q, scaled9_q, scaled10_q;
  logic [65:0] shifted;
  burnish_rom #(.AddressBits(8), .Width(28), .File(RsqrtFile)) i_rom (
    .clk_i, .advance_i(advance), .address_i(m_q[25:18]), .word_o(word)
  );
  assign shifted = {10'b0, nh5_q, 18'b0} >> k_q;
  always_ff @(posedge clk_i) if (advance) begin
    m6_q <= m_q;
    scaled6_q <= shifted[28:0];
  end

  // 7: first 1/sqrt(m), 17 fraction bits; 8: its square, 26 fraction bits; 9: 1 - m / sqrt(m)^2; 10: Newton
  logic        [17:0] root_q, root8_q, root9_q;
  logic        [19:0] fall;
  logic        [35:0] square;
  logic        [26:0] square_q;
  logic        [52:0] near_one;
  logic signed [17:0] off_q;
  logic signed [36:0] step;
  logic        [26:0] fine_q;
  assign fall = word[9:0] * m6_q[17:8];
  assign square = root_q * root_q;
  assign near_one = {27'b0, m8_q} * {26'b0, square_q};
  assign step = $signed({1'b0, root9_q}) * off_q;
  always_ff @(posedge clk_i) if (advance) begin
    root_q <= word[27:10] - {8'b0, fall[19:10]};
    m7_q <= m6_q;
    scaled7_q <= scaled6_q;
    square_q <= square[34:8];
    root8_q <= root_q;
    m8_q <= m7_q;
    scaled8_q <= scaled7_q;
    off_q <= 18'd0 - near_one[39:22];  // modulo 2^18: the difference is below 2^15
    root9_q <= root8_q;
    scaled9_q <= scaled8_q;
    fine_q <= {root9_q, 9'b0} + {{10{step[36]}}, step[36:20]};
    scaled10_q <= scaled9_q;
  end

  // 11: cosine with one bit to round; 12: versine
  logic [55:0]            product;
  logic [VersineBits+3:0] cosine_q, rounded;
  logic [5:0]             none_qs, full_qs;
  assign product = {27'b0, scaled10_q} * {29'b0, fine_q};
  assign rounded = (cosine_q + 1'b1) >> 1;
  always_ff @(posedge clk_i) if (advance) begin
    none_qs <= {none_qs[4:0], none_q};
    full_qs <= {full_qs[4:0], full_q};
    cosine_q <= product[51-VersineBits+:VersineBits+4];
    if (none_qs[5]) versine_o <= '0;
    else if (full_qs[5]) versine_o <= One;
    else versine_o <= rounded[VersineBits+3:VersineBits] != '0 ? '0 : One - rounded[VersineBits:0];
  end

  logic unused;
  assign unused = ^{nn_q[37:36], nn_q[7:0], hh_q[7:0], aligned[31:0], shifted[65:29], fall[9:0], square[35],
                    square[7:0], near_one[52:40], near_one[21:0], step[19:0],
                    product[55], product[50-VersineBits:0]};
endmodule
