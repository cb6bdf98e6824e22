// sum over i of (digit_i - 1) b 4^i modulo 2^Width, digits of two bits in [0, 3]: a tree of adders that
// halves itself until one digit is left. A digit's product is one of ~b, 0, b and 2 b, one lookup a bit; the
// 1 that ~b lacks of -b goes into a free place of the adder above, so the last digit's is left to the caller
// (negative_o).
// Cuts: bit 0 puts a register behind the digits' products, bit l behind level l of the tree; the latency is their
// number. With Split > 0 the bits from Split on come one clock later than those below, in every adder, so that no carry
// runs through more than half of one.
module burnish_digit_sum #(
  parameter int Digits = 6,
  parameter int BBits  = 24,
  parameter int Width  = 25,
  parameter int Level  = 3,  // Digits <= 2^Level
  parameter int Cuts   = 0,
  parameter int Split  = 0   // 0, or from 2 Digits to Width - 1
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
    logic [Width-1:0] b, b_q;
    logic [1:0]       digit_q;
    logic             unused;
    if (Width > BBits) assign b = {{(Width - BBits){1'b0}}, b_i};
    else assign b = b_i[Width-1:0];
    burnish_cut #(.Width(Width + 2), .Enable(Split > 0)) i_late (
      .clk_i, .advance_i, .data_i({b, digits_i}), .data_o({b_q, digit_q})
    );
    for (genvar i = 0; i < Width; i++) begin : gen_bit
      logic [1:0] digit;
      logic       once, twice;
      assign digit = i < Split ? digits_i : digit_q;
      assign once = i < Split ? b[i] : b_q[i];
      if (i > 0) begin : gen_twice
        assign twice = i < Split ? b[i-1] : b_q[i-1];
      end else begin : gen_none
        assign twice = 1'b0;
      end
      assign sum[i] = digit == 2'd0 ? ~once : digit == 2'd2 ? once : digit == 2'd3 & twice;
    end
    assign negative = digits_i == 2'd0;
    assign unused = ^b_i;
  end else begin : gen_tree
    logic [Width-1:0] left;
    logic             left_negative;
    burnish_digit_sum #(
      .Digits(Left), .BBits(BBits), .Width(Width), .Level(Level - 1), .Cuts(Cuts), .Split(Split)
    ) i_left (
      .clk_i, .advance_i, .digits_i(digits_i[2*Left-1:0]), .b_i, .sum_o(left), .negative_o(left_negative)
    );
    if (Digits > Left && Width > Low + 2) begin : gen_both
      logic [Width-Low-3:0] right;
      burnish_digit_sum #(
        .Digits(Digits - Left), .BBits(BBits), .Width(Width - Low - 2), .Level(Level - 1), .Cuts(Cuts),
        .Split(Split > 0 ? Split - Low - 2 : 0)
      ) i_right (
        .clk_i, .advance_i, .digits_i(digits_i[2*Digits-1:2*Left]), .b_i, .sum_o(right), .negative_o(negative)
      );
      if (Split > 0) begin : gen_split
        logic [Width-Low-1:0] shifted;
        logic                 carry, carry_q;
        assign shifted = {right, 1'b0, left_negative};
        assign {carry, sum[Split-1:Low]} = {1'b0, left[Split-1:Low]} + {1'b0, shifted[Split-Low-1:0]};
        burnish_cut #(.Width(1)) i_carry (.clk_i, .advance_i, .data_i(carry), .data_o(carry_q));
        assign sum[Width-1:Split] = left[Width-1:Split] + shifted[Width-Low-1:Split-Low]
                                  + {{(Width - Split - 1){1'b0}}, carry_q};
      end else begin : gen_whole
        assign sum[Width-1:Low] = left[Width-1:Low] + {right, 1'b0, left_negative};
      end
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
