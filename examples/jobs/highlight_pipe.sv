// A stage of a shading pipeline that adds a highlight: colour + light * c^e, one pixel a clock, with valid and ready on
// both sides. The power is a block that burnish wrote; what belongs to a pixel waits beside it in a queue as deep as the
// block.
//
//   burnish hw generate --method w8 --out-bits 8 --depth 6 --name highlight -o highlight
//   cd highlight && iverilog -g2012 -f highlight.f ../highlight_pipe.sv -s highlight_pipe_tb && ./a.out
module highlight_pipe #(
  parameter int Depth = 6  // clocks of the block
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        valid_i,
  output logic        ready_o,
  input  logic [9:0]  exponent_i,
  input  logic [15:0] cosine_i,  // Q1.15
  input  logic [7:0]  colour_i,  // what the stages before made of the pixel
  input  logic [7:0]  light_i,   // strength of the light, 255 is 1
  output logic        valid_o,
  input  logic        ready_i,
  output logic [7:0]  colour_o
);
  logic [7:0]  power;
  logic        take;
  logic [15:0] waiting [Depth];
  logic [16:0] product;
  logic [8:0]  sum;

  highlight i_highlight (
    .clk_i, .rst_ni, .valid_i, .ready_o, .exponent_i, .input_i(cosine_i), .valid_o, .ready_i, .value_o(power)
  );

  // All registers of the block advance together, so a shift register that advances with them keeps a pixel's data level
  // with its power.
  assign take = ready_o;
  always_ff @(posedge clk_i) begin
    if (take) begin
      waiting[0] <= {colour_i, light_i};
      for (int i = 1; i < Depth; i++) waiting[i] <= waiting[i-1];
    end
  end

  // light * power / 255, rounded, then a sum that stays at white.
  assign product = waiting[Depth-1][7:0] * power + 17'd128;
  assign sum = {1'b0, waiting[Depth-1][15:8]} + {1'b0, 8'((product + (product >> 8)) >> 8)};
  assign colour_o = sum[8] ? 8'd255 : sum[7:0];
endmodule

// 400 pixels with pauses on both sides; each answer is compared with the same sum of doubles.
module highlight_pipe_tb;
  localparam int Pixels = 400;
  logic        clk = 0, rst_n = 0, valid_in = 0, ready_in, valid_out, ready_out = 0;
  logic [9:0]  exponent;
  logic [15:0] cosine;
  logic [7:0]  colour, light, answer;
  int          sent = 0, received = 0, clocks = 0;
  real         worst = 0;

  highlight_pipe dut (
    .clk_i(clk), .rst_ni(rst_n), .valid_i(valid_in), .ready_o(ready_in), .exponent_i(exponent), .cosine_i(cosine),
    .colour_i(colour), .light_i(light), .valid_o(valid_out), .ready_i(ready_out), .colour_o(answer)
  );

  // What belongs to pixel i, the same when it is sent and when it is checked.
  function automatic logic [9:0] exponent_of(input int i);
    return 10'(8 + 7 * (i % 100));
  endfunction
  function automatic logic [15:0] cosine_of(input int i);
    return 16'(32768 - (i * 37) % 4000);
  endfunction
  function automatic logic [7:0] colour_of(input int i);
    return 8'(i * 5);
  endfunction
  function automatic logic [7:0] light_of(input int i);
    return 8'(255 - i);
  endfunction
  function automatic real expected(input int i);
    real value;
    value = 1.0 * colour_of(i) + light_of(i) * $pow(cosine_of(i) / 32768.0, 1.0 * exponent_of(i));
    return value > 255.0 ? 255.0 : value;
  endfunction

  assign exponent = exponent_of(sent);
  assign cosine = cosine_of(sent);
  assign colour = colour_of(sent);
  assign light = light_of(sent);
  always #5 clk = ~clk;
  initial #22 rst_n = 1;

  always @(posedge clk) if (rst_n) begin
    clocks <= clocks + 1;
    if (valid_in && ready_in) begin
      sent <= sent + 1;
      valid_in <= sent + 1 < Pixels && $urandom_range(3) != 0;
    end else if (!valid_in) valid_in <= sent < Pixels && $urandom_range(3) != 0;
    ready_out <= $urandom_range(3) != 0;
    if (valid_out && ready_out) begin
      if (answer - expected(received) > worst) worst = answer - expected(received);
      if (expected(received) - answer > worst) worst = expected(received) - answer;
      received <= received + 1;
      if (received == Pixels - 1) begin
        // The block is at most 4.73 levels off from exponent 5 on (docs/results/hardware.md); rounding adds a half.
        $display("%s %0d pixels in %0d clocks, at most %0.2f levels off", worst < 5.23 ? "PASS" : "FAIL", Pixels,
                 clocks, worst);
        $finish;
      end
    end
    if (clocks > 20 * Pixels) begin
      $display("FAIL only %0d of %0d answers", received, Pixels);
      $finish;
    end
  end
endmodule
