// floor(a b / 2^Drop), OutBits wide. With Saturate, overflow_o tells that the value does not fit
// (product_o is then meaningless); without, OutBits must hold every product.
// a is read in digits of two bits, each lowered by one: -1, 0, 1, 2 need no multiple but b and 2 b.
// Cuts: bit 0 puts a register behind the multiples of b, bit l behind level l of the adder tree, and bit Levels + 1
// splits every adder into two halves, the upper one a clock later; the latency is their number.
// Levels = ceil(log2(floor(ABits / 2) + 1)).
module burnish_product #(
  parameter int ABits    = 10,
  parameter int BBits    = 24,
  parameter int Drop     = 10,
  parameter int OutBits  = 14,
  parameter bit Saturate = 1,
  parameter int Cuts     = 0
) (
  input  logic               clk_i,
  input  logic               advance_i,
  input  logic [ABits-1:0]   a_i,
  input  logic [BBits-1:0]   b_i,
  output logic [OutBits-1:0] product_o,
  output logic               overflow_o
);
  localparam int Digits = ABits / 2 + 1;
  localparam int Levels = $clog2(Digits);
  localparam int Top    = Drop + OutBits;
  localparam int Width  = Top + (Saturate ? 1 : 0);
  localparam int Split  = Cuts[Levels+1] ? (2 * Digits > Width / 2 ? 2 * Digits : Width / 2) : 0;

  logic [2*Digits-1:0] digits;
  logic [Width-1:0]    sum, product;
  logic [Levels+2:0]   excess;  // bit l + 1: behind level l
  logic                excess_d, unused;

  assign digits = {{(2 * Digits - ABits){1'b0}}, a_i} + {Digits{2'b01}};
  burnish_digit_sum #(
    .Digits(Digits), .BBits(BBits), .Width(Width), .Level(Levels), .Cuts(Cuts), .Split(Split)
  ) i_sum (
    .clk_i, .advance_i, .digits_i(digits), .b_i, .sum_o(sum), .negative_o(unused)
  );
  assign excess[0] = excess_d;
  for (genvar l = 0; l <= Levels + 1; l++) begin : gen_excess
    burnish_cut #(.Width(1), .Enable(Cuts[l])) i_excess (
      .clk_i, .advance_i, .data_i(excess[l]), .data_o(excess[l+1])
    );
  end
  if (Split > 0) begin : gen_wait
    assign product[Width-1:Split] = sum[Width-1:Split];
    burnish_cut #(.Width(Split)) i_low (.clk_i, .advance_i, .data_i(sum[Split-1:0]), .data_o(product[Split-1:0]));
  end else begin : gen_whole
    assign product = sum;
  end
  assign product_o = product[Top-1:Drop];
  if (Drop > 0) begin : gen_low
    logic unused_low;
    assign unused_low = ^product[Drop-1:0];
  end

  // Leading ones at i and j with i + j >= Top: too large for sure. Otherwise a b < 2^(Top + 1), and bit Top
  // of the sum tells.
  if (Saturate) begin : gen_overflow
    logic b_above;  // a one in b at j or above
    always_comb begin
      excess_d = 1'b0;
      b_above = 1'b0;
      for (int j = BBits - 1; j >= 0; j--) begin
        b_above |= b_i[j];
        for (int i = 0; i < ABits; i++)
          if (i + j == Top || (i > Top && j == 0)) excess_d |= a_i[i] & b_above;
      end
    end
    assign overflow_o = excess[Levels+2] | product[Top];
  end else begin : gen_fits
    logic unused_excess;
    assign excess_d = 1'b0;
    assign overflow_o = 1'b0;
    assign unused_excess = excess[Levels+2];
  end
endmodule
