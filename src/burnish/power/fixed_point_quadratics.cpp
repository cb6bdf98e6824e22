// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/power/fixed_point_core.h>

namespace burnish {
namespace {

constexpr int kSegmentBits = 6;  // 64 segments
constexpr std::size_t kSegments = std::size_t{1} << kSegmentBits;

// A falling convex function: start - (fall t >> .) + (bend t^2 >> .) for t in [0, 1) of `low_bits` bits within a
// segment.
struct QuadraticTable {
  int value_bits, low_bits, fall_bits, bend_bits, square_bits;
  std::array<std::uint64_t, kSegments> start{}, fall{}, bend{};

  // `value_bits` are fraction bits of the function; the first difference over a segment is below 2^(value_bits - drop).
  QuadraticTable(int value, int low, int drop) : value_bits(value), low_bits(low) {
    fall_bits = value_bits - drop;
    bend_bits = std::max(0, value_bits - drop - 7);
    square_bits = std::min(2 * low_bits, bend_bits + 1);
  }

  std::uint64_t value(std::uint64_t x) const noexcept {
    const std::size_t i = x >> low_bits;
    const std::uint64_t t = x & (power_of_two(low_bits) - 1);
    const std::uint64_t square = bend_bits > 0 ? (t * t) >> (2 * low_bits - square_bits) : 0;
    return start[i] - ((fall[i] * t) >> low_bits) + (bend_bits > 0 ? (bend[i] * square) >> square_bits : 0);
  }

  // Fills the table from `function`, in steps of 2^-value_bits, of x in whole segments.
  template <typename Function>
  void fill(const Function& function) {
    for (std::size_t i = 0; i < kSegments; ++i) {
      const auto at = static_cast<double>(i);
      const double begin = function(at), middle = function(at + 0.5), end = function(at + 1);
      const double second = 2 * (begin - 2 * middle + end);
      const double slope = begin - end + (bend_bits > 0 ? second : 0);
      fall[i] = std::min<std::uint64_t>(static_cast<std::uint64_t>(std::llround(slope)),
                                        power_of_two(fall_bits) - 1);
      bend[i] = bend_bits > 0 ? std::min<std::uint64_t>(static_cast<std::uint64_t>(std::llround(second)),
                                                        power_of_two(bend_bits) - 1)
                              : 0;

      // the start in the middle of the largest and the least error
      start[i] = power_of_two(value_bits + 1);
      double least = HUGE_VAL, largest = -HUGE_VAL;
      for (std::uint64_t t = 0; t < power_of_two(low_bits); ++t) {
        const std::uint64_t x = (std::uint64_t{i} << low_bits) + t;
        const double off =
            function(std::ldexp(static_cast<double>(x), -low_bits)) - static_cast<double>(value(x));
        least = std::min(least, off);
        largest = std::max(largest, off);
      }
      const double moved = static_cast<double>(start[i]) + (least + largest) / 2;
      start[i] = std::min<std::uint64_t>(static_cast<std::uint64_t>(std::llround(moved)),
                                         power_of_two(value_bits) - 1);
      while (static_cast<std::int64_t>(value(((std::uint64_t{i} + 1) << low_bits) - 1)) < 0) ++start[i];
    }
  }

  UnitTable table(const char* name) const {
    UnitTable table{name, value_bits + fall_bits + bend_bits, {}};
    for (std::size_t i = 0; i < kSegments; ++i)
      table.words.push_back((start[i] << fall_bits | fall[i]) << bend_bits | bend[i]);
    return table;
  }
};

// c^e = 2^-(e u), u = -log2 c, the way special function units of graphics processors have it: c is normalized, the
// logarithm of its mantissa and the power of two of the product's fraction are 64 quadratics each. The words have the
// bits that an error below one unit of the last place asks for.
class QuadraticsCore final : public UnitCore {
 public:
  explicit QuadraticsCore(const UnitConfig& config)
      : f_(config.cosine_bits),
        w_(config.output_bits),
        log_bits_(std::max(w_ > 8 ? w_ + 12 : w_ + 11, f_)),
        fraction_bits_(w_ + 2),
        log_(log_bits_, f_ - 1 - kSegmentBits, 5),
        exp_(w_ + 3, fraction_bits_ - kSegmentBits, 6) {
    // 1 - log2 of the mantissa, below 1
    log_.fill([this](double x) { return std::ldexp(1 - std::log2(1 + x / kSegments), log_bits_); });
    exp_.fill([this](double x) {
      return std::ldexp((1 - std::ldexp(1.0, -w_)) * std::exp2(-x / kSegments), exp_.value_bits);
    });
  }

  std::uint32_t value(std::uint32_t exponent, std::uint64_t c, std::uint64_t) const noexcept override {
    if (c == 0) return 0;
    std::uint64_t u = 0;
    if (c < power_of_two(f_)) {
      std::uint64_t octave = 0, mantissa = c;
      while (mantissa < power_of_two(f_ - 1)) mantissa <<= 1, ++octave;
      if (octave > 15) return 0;
      u = (octave << log_bits_) | log_.value(mantissa - power_of_two(f_ - 1));
    }
    const UnitProduct p = unit_product(exponent, u, log_bits_ - fraction_bits_, fraction_bits_ + 4);
    const auto whole = static_cast<int>(p.value >> fraction_bits_);
    if (p.overflow || whole > w_ + 1) return 0;
    const std::uint64_t m = exp_.value(p.value & (power_of_two(fraction_bits_) - 1));
    return static_cast<std::uint32_t>(((m >> (exp_.value_bits - w_ - 1 + whole)) + 1) >> 1);
  }

  std::vector<UnitTable> tables() const override { return {log_.table("log"), exp_.table("exp")}; }

  std::vector<UnitParameter> parameters() const override { return {{"LogBits", log_bits_}}; }

 private:
  int f_, w_;
  int log_bits_;       // fraction bits of u
  int fraction_bits_;  // fraction bits of e u
  QuadraticTable log_, exp_;
};

}  // namespace

std::unique_ptr<UnitCore> make_quadratics_core(const UnitConfig& config) {
  return std::make_unique<QuadraticsCore>(config);
}

}  // namespace burnish
