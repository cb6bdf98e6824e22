// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/power/fixed_point_core.h>

namespace burnish {
namespace {

// c^e = 2^-(e u), u = -log2 c. With v = 1 - c and k leading ones in v's fraction, 2^k v = (2^k - 1) + r, r in
// [0, 1/2), and u = k - log2(1 - r): the same shift serves all octaves, and near c = 1 (k = 0) u keeps the
// relative precision of v. That part is linear in r plus a table; the product with e, exact and then cut,
// splits into whole octaves, a shift, and a fraction whose power of two is a table with slopes.
//
// With 8 bits, -log2(1 - r) is the sum of 2 r, a table over the leading bits of r, and (1/128 - 9/16) times the bits
// below. So the slope within a cell is 185/128, near 1/ln 2, which counts where r is small and e is large. The table
// holds no more than the bump of a binary logarithm, so its words are narrow. A c below 2^-8 needs no octaves: the unit
// takes c from 2^-9 on as 2^-8, and a smaller c as 0.
//
// Each step never falls as v rises, tables included, so the output never rises with v.
class ExactCore final : public UnitCore {
 public:
  explicit ExactCore(const UnitConfig& config) : f_(config.cosine_bits), w_(config.output_bits) {
    wide_ = w_ > 8;
    log_bits_ = wide_ ? w_ + 12 : std::max(w_ + 11, f_);  // e = 1000 leaves 2^-(w + 2) or 2^-(w + 1) of e u
    fraction_bits_ = w_ + 2;
    mantissa_bits_ = w_ + 3;
    log_index_bits_ = w_ > 10 ? 9 : w_ > 8 ? 8 : 7;
    slope_bits_ = log_bits_ - 1 - log_index_bits_;
    exp_index_bits_ = w_ > 10 ? 6 : w_ > 8 ? 5 : 4;
    fill_log_table();
    fill_exp_table();
  }

  std::uint32_t value(std::uint32_t exponent, std::uint64_t, std::uint64_t v) const noexcept override {
    // c = 2^-octave (1 - r): leading ones of v off the front, eight, four, two and one at a time. Three octave bits
    // serve 8-bit outputs: c below 2^-8 counts as the smallest c of octave 7, c below 2^-9 as 0.
    if (!wide_ && ones(v, 9)) return 0;
    std::uint64_t octave = 0, r = v;
    for (int shift = wide_ ? 8 : 4; shift > 0; shift /= 2) {
      if (ones(r, shift)) {
        r = (r << shift) & (power_of_two(f_) - 1);
        octave += static_cast<std::uint64_t>(shift);
      }
      if (shift == 4 && !wide_ && ones(v, 8)) r = power_of_two(f_) - 1;
    }

    // u = -log2 c, then e u; 2^-(e u) by its whole part, a shift, and its fraction, a table
    r &= power_of_two(f_ - 1) - 1;
    const std::uint64_t u = (octave << log_bits_) | log_of(r);
    const UnitProduct p = unit_product(exponent, u, log_bits_ - fraction_bits_, fraction_bits_ + 4);
    const auto whole = static_cast<int>(p.value >> fraction_bits_);
    if (p.overflow || whole > w_ + 1) return 0;
    const std::uint64_t m = exp_of(p.value & (power_of_two(fraction_bits_) - 1));
    return static_cast<std::uint32_t>(((m >> (mantissa_bits_ - w_ - 1 + whole)) + 1) >> 1);
  }

  std::vector<UnitTable> tables() const override {
    std::vector<UnitTable> tables = {{"log", log_word_bits_, log_words_}, {"exp", exp_word_bits(), {}}};
    for (std::size_t i = 0; i < exp_start_.size(); ++i)
      tables[1].words.push_back(exp_start_[i] << exp_slope_bits() | exp_slope_[i]);
    return tables;
  }

  std::vector<UnitParameter> parameters() const override {
    return {{"LogIndexBits", log_index_bits_},
            {"LogWordBits", log_word_bits_},
            {"LogBits", log_bits_},
            {"LogSlopeBits", wide_ ? slope_bits_ + 1 : 0},
            {"ExpIndexBits", exp_index_bits_}};
  }

 private:
  int low_bits() const noexcept { return f_ - 1 - log_index_bits_; }  // of r within a table cell

  /// Returns true if the leading `count` bits of v, or of a remainder, are ones.
  bool ones(std::uint64_t v, int count) const noexcept {
    return v >> (f_ - count) == power_of_two(count) - 1;
  }

  // The part without a table is r itself if the table has slopes. Otherwise it is the sum of 2 r, 1/128 of the low bits
  // of r within a cell, and 72/128 of their distance from their largest value.
  std::uint64_t linear(std::uint64_t r) const noexcept {
    const std::uint64_t x = r << (log_bits_ - f_);
    if (wide_) return x;
    const std::uint64_t largest = power_of_two(low_bits()) - 1, low = r & largest;
    return 2 * x + (((72 * (largest - low) + low) << (log_bits_ - f_)) >> 7);
  }

  // -log2(1 - r) in steps of 2^-log_bits_.
  std::uint64_t log_of(std::uint64_t r) const noexcept {
    const std::size_t i = r >> low_bits();
    const std::uint64_t rest = r & (power_of_two(low_bits()) - 1);
    const std::uint64_t slope = wide_ ? (log_slope_[i] * (rest << (log_bits_ - f_))) >> slope_bits_ : 0;
    return linear(r) + log_start_[i] + slope;  // modulo 2^64: starts of 8 bits are negative
  }
  double true_log(std::uint64_t r) const {
    return -std::ldexp(std::log1p(-std::ldexp(static_cast<double>(r), -f_)) / std::log(2.0), log_bits_);
  }

  void fill_log_table() {
    const std::size_t cells = power_of_two(log_index_bits_);
    log_start_.assign(cells, 0);
    log_slope_.assign(cells, 0);
    const int finest = log_bits_ - 2;                         // bits of the largest entry, 0.279
    const std::uint64_t limit = power_of_two(log_bits_) - 1;  // u - k stays below 1
    for (std::size_t i = 0; i < cells; ++i) {
      const std::uint64_t first = std::uint64_t{i} << low_bits(), last = first + power_of_two(low_bits()) - 1;
      // the slope over the cell, of what the linear part leaves
      if (wide_) {
        const double rise = true_log(last + 1) - true_log(first) -
                            static_cast<double>(power_of_two(low_bits() + log_bits_ - f_));
        log_slope_[i] =
            static_cast<std::uint64_t>(std::ldexp(rise, slope_bits_ - low_bits() - (log_bits_ - f_)));
      }

      // the middle of the largest and the least error, found at the cell's ends and in its middle
      double least = HUGE_VAL, largest = -HUGE_VAL;
      const std::uint64_t step = std::max<std::uint64_t>(1, (last - first) / 64);
      for (std::uint64_t r = first;; r = std::min(r + step, last)) {
        const double off = true_log(r) - static_cast<double>(static_cast<std::int64_t>(log_of(r)));
        least = std::min(least, off);
        largest = std::max(largest, off);
        if (r == last) break;
      }

      // rounded; not below the cell before it, not below 0, and below 1 at its end
      const int drop = wide_ ? 0 : log_bits_ - (w_ + 11);
      const double middle = i == 0 && wide_ ? 0 : (least + largest) / 2;
      auto word =
          static_cast<std::int64_t>(std::llround(std::ldexp(wide_ ? std::max(0.0, middle) : middle, -drop)));
      const auto answer = [&](std::uint64_t r) { return static_cast<std::int64_t>(log_of(r)); };
      const auto set = [&] { log_start_[i] = static_cast<std::uint64_t>(word) << drop; };
      set();
      while (answer(first) < (i == 0 ? 0 : answer(first - 1))) ++word, set();
      while (answer(last) > static_cast<std::int64_t>(limit)) --word, set();
      log_words_.push_back(wide_ ? log_start_[i] << (slope_bits_ + 1) | log_slope_[i]
                                 : static_cast<std::uint64_t>(word) & (power_of_two(w_ + 8) - 1));
    }
    log_word_bits_ = wide_ ? finest + 1 + slope_bits_ + 1 : w_ + 8;
  }

  int rest_bits() const noexcept { return fraction_bits_ - exp_index_bits_; }
  // The slope counts steps of 2^-mantissa_bits_ over a cell of 2^rest_bits() steps of the fraction.
  int exp_slope_bits() const noexcept { return mantissa_bits_ - exp_index_bits_; }
  int exp_word_bits() const noexcept { return mantissa_bits_ + exp_slope_bits(); }

  // (1 - 2^-w) 2^-x in steps of 2^-mantissa_bits_: the factor makes the largest output 2^w - 1.
  std::uint64_t exp_of(std::uint64_t x) const noexcept {
    const std::size_t i = x >> rest_bits();
    return exp_start_[i] - ((exp_slope_[i] * (x & (power_of_two(rest_bits()) - 1))) >> rest_bits());
  }
  double true_exp(double x) const {
    return std::ldexp(1 - std::ldexp(1.0, -w_), mantissa_bits_) * std::exp2(-std::ldexp(x, -fraction_bits_));
  }

  void fill_exp_table() {
    const int cells = 1 << exp_index_bits_;
    const double width = std::ldexp(1.0, rest_bits());
    exp_start_.resize(static_cast<std::size_t>(cells));
    exp_slope_.resize(static_cast<std::size_t>(cells));
    for (int i = cells - 1; i >= 0; --i) {
      const auto cell = static_cast<std::size_t>(i);
      const auto first = static_cast<std::uint64_t>(i) << rest_bits();
      const std::uint64_t last = first + power_of_two(rest_bits()) - 1;
      const double begin = static_cast<double>(first);

      // the slope to the cell's end, then the start in the middle of the largest and the least error
      exp_slope_[cell] = static_cast<std::uint64_t>(std::llround(true_exp(begin) - true_exp(begin + width)));
      exp_start_[cell] = power_of_two(mantissa_bits_);  // above the slope's fall, so that no difference wraps
      double least = HUGE_VAL, largest = -HUGE_VAL;
      for (std::uint64_t x = first; x <= last; ++x) {
        // the product was cut, by half a step on average
        const double off = true_exp(static_cast<double>(x) + 0.5) - static_cast<double>(exp_of(x));
        least = std::min(least, off);
        largest = std::max(largest, off);
      }
      exp_start_[cell] = static_cast<std::uint64_t>(
          std::llround(static_cast<double>(exp_start_[cell]) + (least + largest) / 2));

      // no rise where cells meet
      if (i + 1 < cells)
        while (exp_of(last) < exp_of(last + 1)) --exp_slope_[cell];
    }
  }

  int f_, w_;
  bool wide_;          // more than 8 bits: the logarithm has slopes too
  int log_bits_;       // fraction bits of u
  int fraction_bits_;  // fraction bits of e u
  int mantissa_bits_;  // fraction bits of the power of two
  int log_index_bits_, slope_bits_, exp_index_bits_, log_word_bits_ = 0;
  std::vector<std::uint64_t> log_start_, log_slope_, log_words_, exp_start_, exp_slope_;
};

}  // namespace

std::unique_ptr<UnitCore> make_exact_core(const UnitConfig& config) {
  return std::make_unique<ExactCore>(config);
}

}  // namespace burnish
