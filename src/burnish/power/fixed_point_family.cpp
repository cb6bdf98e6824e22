// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/power/fixed_point_core.h>

// The members of the family besides the exact power. Intermediate values carry guard bits beyond the output:
// fraction_bits = output_bits + 4.

namespace burnish {
namespace {

constexpr int kGuardBits = 4;

std::uint64_t to_fixed(double x, int fraction_bits) {
  return static_cast<std::uint64_t>(std::llround(std::ldexp(x, fraction_bits)));
}

// The paper's PROM: a(e), ten whole bits, for every exponent.
class Prom {
 public:
  explicit Prom(int width) : width_(width) {
    for (int e = 1; e <= kUnitMaxExponent; ++e)
      words_.push_back(to_fixed(quadratic_coefficient(e), fraction_bits()));
    words_.insert(words_.begin(), 0);  // exponent 0 is not used
  }
  int fraction_bits() const noexcept { return width_ - 10; }
  std::uint64_t operator[](std::uint32_t exponent) const noexcept { return words_[exponent]; }
  std::vector<UnitTable> tables() const { return {{"prom", width_, words_}}; }

 private:
  int width_;
  std::vector<std::uint64_t> words_;
};

// a (c^2 - c) + c step by step.
class PaperLiteralCore final : public UnitCore {
 public:
  explicit PaperLiteralCore(const UnitConfig& config)
      : f_(config.cosine_bits),
        w_(config.output_bits),
        g_(w_ + kGuardBits),
        d_(w_ + 12),
        prom_(config.coefficient_bits) {}

  std::uint32_t value(std::uint32_t exponent, std::uint64_t c, std::uint64_t) const noexcept override {
    // a up to 805 multiplies what is cut here: d_ leaves 2^-(w + 2)
    const std::uint64_t square = rescale(c * c, 2 * f_, d_);
    const std::uint64_t fall = rescale(c, f_, d_) - square;  // c - c^2 >= 0
    const UnitProduct p = unit_product(prom_[exponent], fall, prom_.fraction_bits() + d_ - g_, g_);
    const std::uint64_t top = rescale(c, f_, g_);
    return unit_scale(p.overflow || p.value > top ? 0 : top - p.value, g_, w_);
  }
  std::vector<UnitTable> tables() const override { return prom_.tables(); }

 private:
  int f_, w_, g_, d_;
  Prom prom_;
};

// c max(0, 1 - a v).
class PaperCore final : public UnitCore {
 public:
  explicit PaperCore(const UnitConfig& config)
      : f_(config.cosine_bits), w_(config.output_bits), g_(w_ + kGuardBits), prom_(config.coefficient_bits) {}

  std::uint32_t value(std::uint32_t exponent, std::uint64_t c, std::uint64_t v) const noexcept override {
    const UnitProduct p = unit_product(prom_[exponent], v, prom_.fraction_bits() + f_ - g_, g_);
    const std::uint64_t factor = p.overflow ? 0 : power_of_two(g_) - p.value;
    return unit_scale((factor * rescale(c, f_, g_)) >> g_, g_, w_);
  }
  std::vector<UnitTable> tables() const override { return prom_.tables(); }

 private:
  int f_, w_, g_;
  Prom prom_;
};

// max(0, 1 - k v)^8, k affine in e: no table.
class W8Core final : public UnitCore {
 public:
  explicit W8Core(const UnitConfig& config)
      : f_(config.cosine_bits), w_(config.output_bits), g_(w_ + kGuardBits + 1) {
    k_fraction_bits_ = config.coefficient_bits - 7;  // k is below 118
    constexpr double kFirst = 5, kLast = kMaxExponent;
    const double first = power_coefficients(PowerMethod::w8, kFirst).k[0];
    const double slope = (power_coefficients(PowerMethod::w8, kLast).k[0] - first) / (kLast - kFirst);
    slope_ = to_fixed(slope, kSlopeBits);
    offset_ = to_fixed(first - kFirst * slope, kSlopeBits);
  }

  std::uint32_t value(std::uint32_t exponent, std::uint64_t, std::uint64_t v) const noexcept override {
    const std::uint64_t k = rescale(exponent * slope_ + offset_, kSlopeBits, k_fraction_bits_);
    const UnitProduct p = unit_product(k, v, k_fraction_bits_ + f_ - g_, g_);
    std::uint64_t w = p.overflow ? 0 : power_of_two(g_) - p.value;
    for (int i = 0; i < 3; ++i) w = (w * w) >> g_;
    return unit_scale(w, g_, w_);
  }
  std::vector<UnitParameter> parameters() const override {
    return {{"Slope", static_cast<std::int64_t>(slope_)},
            {"Offset", static_cast<std::int64_t>(offset_)},
            {"SlopeBits", kSlopeBits}};
  }

 private:
  static constexpr int kSlopeBits = 12;
  int f_, w_, g_, k_fraction_bits_;
  std::uint64_t slope_, offset_;
};

// max(0, m - n s)^2 + o with s = e v; m, n, o by s < split. They depend on e slowly: 24 rows do, chosen by
// the exponent's leading bits. Exponent 1 is c itself.
class TwoPieceCore final : public UnitCore {
 public:
  explicit TwoPieceCore(const UnitConfig& config)
      : f_(config.cosine_bits),
        w_(config.output_bits),
        g_(w_ + kGuardBits),
        n_bits_(config.coefficient_bits) {
    rows_.resize(kRows);
    for (int row = 2; row < kRows; ++row) fill(row);
  }

  std::uint32_t value(std::uint32_t exponent, std::uint64_t c, std::uint64_t v) const noexcept override {
    if (exponent <= 1) return unit_scale(rescale(c, f_, g_), g_, w_);
    const UnitProduct s = unit_product(exponent, v, f_ - g_, g_ + kWholeBits);
    if (s.overflow || c == 0) return 0;
    return unit_scale(shape(rows_[static_cast<std::size_t>(row_of(exponent))], s.value), g_, w_);
  }

  std::vector<UnitTable> tables() const override {
    UnitTable split{"split", 2 * g_ + 2, {}}, near{"near", g_ + n_bits_, {}}, far{"far", g_ + n_bits_, {}};
    for (const TwoPieceRow& row : rows_) {
      split.words.push_back(row.split << g_ | row.o);
      near.words.push_back(row.m[0] << n_bits_ | row.n[0]);
      far.words.push_back(row.m[1] << n_bits_ | row.n[1]);
    }
    return {split, near, far};
  }

 private:
  static constexpr int kRows = 24;
  static constexpr int kWholeBits = 3;  // s = 8 and more gives 0
  struct TwoPieceRow {
    std::uint64_t split = 0, o = 0, m[2] = {}, n[2] = {};
  };

  static constexpr int row_of(std::uint32_t e) noexcept {
    if (e < 16) return static_cast<int>(e);
    if (e < 32) return 16 + static_cast<int>((e >> 2) & 3);
    if (e < 64) return 20 + static_cast<int>((e >> 4) & 1);
    return e < 128 ? 22 : 23;
  }

  std::uint64_t shape(const TwoPieceRow& row, std::uint64_t s) const noexcept {
    const bool far = s >= row.split;
    const std::uint64_t fall = (row.n[far] * s) >> n_bits_;
    const std::uint64_t w = row.m[far] > fall ? row.m[far] - fall : 0;
    return ((w * w) >> g_) + (far ? 0 : row.o);
  }

  void fill(int index) {
    double inverse = 0;  // the coefficients are functions of 1 / e: take its mean
    int count = 0;
    for (std::uint32_t e = 2; e <= kUnitMaxExponent; ++e)
      if (row_of(e) == index) {
        inverse += 1.0 / e;
        ++count;
      }
    const double e = count / inverse;
    const PowerCoefficients k = power_coefficients(PowerMethod::two_piece, e);
    TwoPieceRow& row = rows_[static_cast<std::size_t>(index)];
    row.split = to_fixed(k.k[0] * e, g_);
    row.m[0] = to_fixed(k.k[1], g_);
    row.n[0] = to_fixed(k.k[2] / e, n_bits_);
    row.o = power_of_two(g_) - ((row.m[0] * row.m[0]) >> g_);  // 1 at s = 0, to the last bit
    row.m[1] = to_fixed(k.k[4], g_);
    row.n[1] = to_fixed(k.k[5] / e, n_bits_);
    while (shape(row, row.split) > shape(row, row.split - 1)) --row.m[1];  // no rise where the pieces meet
  }

  int f_, w_, g_, n_bits_;
  std::vector<TwoPieceRow> rows_;
};

// c / (c + e v), bit by bit.
class SchlickCore final : public UnitCore {
 public:
  explicit SchlickCore(const UnitConfig& config)
      : f_(config.cosine_bits), w_(config.output_bits), g_(w_ + 2) {}

  std::uint32_t value(std::uint32_t exponent, std::uint64_t c, std::uint64_t v) const noexcept override {
    const std::uint64_t below = c + exponent * v;
    return unit_scale((c << g_) / below, g_, w_);
  }

 private:
  int f_, w_, g_;
};

}  // namespace

std::unique_ptr<UnitCore> make_paper_literal_core(const UnitConfig& config) {
  return std::make_unique<PaperLiteralCore>(config);
}
std::unique_ptr<UnitCore> make_paper_core(const UnitConfig& config) {
  return std::make_unique<PaperCore>(config);
}
std::unique_ptr<UnitCore> make_w8_core(const UnitConfig& config) {
  return std::make_unique<W8Core>(config);
}
std::unique_ptr<UnitCore> make_two_piece_core(const UnitConfig& config) {
  return std::make_unique<TwoPieceCore>(config);
}
std::unique_ptr<UnitCore> make_schlick_core(const UnitConfig& config) {
  return std::make_unique<SchlickCore>(config);
}

}  // namespace burnish
