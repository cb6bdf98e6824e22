// sum over i of (digit_i - 1) b 4^i modulo 2^Width, digits of two bits in [0, 3]: a tree of adders that
// halves itself until one digit is left. A digit's product is one of ~b, 0, b and 2 b, one lookup a bit; the
// 1 that ~b lacks of -b goes into a free place of the adder above, so the last digit's is left to the caller
// (negative_o).
// Cuts: bit 0 puts a register behind the digits' products, bit l behind level l of the tree; the latency is their
// number.
module burnish_digit_sum #(
  parameter int Digits = 6,
  parameter int BBits  = 24,
  parameter int Width  = 25,
  parameter int Level  = 3,  // Digits <= 2^Level
  parameter int Cuts   = 0
) (
  input  logic                clk_i,
  input  logic                advance_i,
  input  logic [2*Digits-1:0] digits_i,
  input  logic [BBits-1:0]    b_i,
  output logic [Width-1:0]    sum_o,
  output logic                negative_o
);
  localparam int Left = Digits > 2 ** (Level - 1) && Level > 0 ? 2 ** (Level - 1) : Digits;
  localparam int Low  = 2 * Left - 2;  // where the right half's free places begin

  logic [Width-1:0] sum;
  logic             negative;
  if (Level == 0) begin : gen_digit
    logic [Width-1:0] b;
    logic             unused;
    if (Width > BBits) assign b = {{(Width - BBits){1'b0}}, b_i};
    else assign b = b_i[Width-1:0];
    always_comb begin
      case (digits_i)
        2'd0: sum = ~b;
        2'd1: sum = '0;
        2'd2: sum = b;
        default: sum = b << 1;
      endcase
    end
    assign negative = digits_i == 2'd0;
    assign unused = ^b_i;
  end else begin : gen_tree
    logic [Width-1:0] left;
    logic             left_negative;
    burnish_digit_sum #(
      .Digits(Left), .BBits(BBits), .Width(Width), .Level(Level - 1), .Cuts(Cuts)
    ) i_left (
      .clk_i, .advance_i, .digits_i(digits_i[2*Left-1:0]), .b_i, .sum_o(left), .negative_o(left_negative)
    );
    if (Digits > Left && Width > Low + 2) begin : gen_both
      logic [Width-Low-3:0] right;
      burnish_digit_sum #(
        .Digits(Digits - Left), .BBits(BBits), .Width(Width - Low - 2), .Level(Level - 1), .Cuts(Cuts)
      ) i_right (
        .clk_i, .advance_i, .digits_i(digits_i[2*Digits-1:2*Left]), .b_i, .sum_o(right), .negative_o(negative)
      );
      assign sum[Width-1:Low] = left[Width-1:Low] + {right, 1'b0, left_negative};
      if (Low > 0) begin : gen_low
        assign sum[Low-1:0] = left[Low-1:0];
      end
    end else begin : gen_left
      logic unused;
      assign unused = ^digits_i;
      assign sum = left;
      assign negative = left_negative;
    end
  end
  burnish_cut #(.Width(Width + 1), .Enable(Cuts[Level])) i_cut (
    .clk_i, .advance_i, .data_i({sum, negative}), .data_o({sum_o, negative_o})
  );
endmodule
