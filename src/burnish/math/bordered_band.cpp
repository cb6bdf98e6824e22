#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <burnish/error.h>
#include <burnish/math/bordered_band.h>

#define HWY_TARGET_INCLUDE "burnish/math/bordered_band.cpp"
#include <burnish/math/highway-inl.h>

#ifndef BURNISH_MATH_BORDERED_BAND
#define BURNISH_MATH_BORDERED_BAND
namespace burnish {
namespace {

constexpr std::size_t kRowsTogether = 4, kMaxEntries = 16;

// A matrix's rows from one entry on, each so many numbers after the one before.
struct Rows {
  double* first;
  std::size_t step;
};
struct ConstRows {
  const double* first;
  std::size_t step;
};

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

// Of four rows, at least `count` entries each: entry (r, j) minus the sum over k < terms of left(k, r) right(k, j), one
// product after another.
void subtract_products(const Rows& to, std::size_t count, const ConstRows& left, const ConstRows& right,
                       std::size_t terms) {
  const hn::CappedTag<double, kMaxEntries / 2> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t j = 0; j < count; j += 2 * lanes) {
    double* const tile = to.first + j;
    auto a0 = hn::LoadU(d, tile), a1 = hn::LoadU(d, tile + lanes);
    auto b0 = hn::LoadU(d, tile + to.step), b1 = hn::LoadU(d, tile + to.step + lanes);
    auto c0 = hn::LoadU(d, tile + 2 * to.step), c1 = hn::LoadU(d, tile + 2 * to.step + lanes);
    auto e0 = hn::LoadU(d, tile + 3 * to.step), e1 = hn::LoadU(d, tile + 3 * to.step + lanes);
    const double *l = left.first, *r = right.first + j;
    for (std::size_t k = 0; k < terms; ++k, l += left.step, r += right.step) {
      const auto r0 = hn::LoadU(d, r), r1 = hn::LoadU(d, r + lanes);
      const auto la = hn::Set(d, l[0]), lb = hn::Set(d, l[1]), lc = hn::Set(d, l[2]), le = hn::Set(d, l[3]);
      a0 = hn::Sub(a0, hn::Mul(la, r0));
      a1 = hn::Sub(a1, hn::Mul(la, r1));
      b0 = hn::Sub(b0, hn::Mul(lb, r0));
      b1 = hn::Sub(b1, hn::Mul(lb, r1));
      c0 = hn::Sub(c0, hn::Mul(lc, r0));
      c1 = hn::Sub(c1, hn::Mul(lc, r1));
      e0 = hn::Sub(e0, hn::Mul(le, r0));
      e1 = hn::Sub(e1, hn::Mul(le, r1));
    }
    hn::StoreU(a0, d, tile);
    hn::StoreU(a1, d, tile + lanes);
    hn::StoreU(b0, d, tile + to.step);
    hn::StoreU(b1, d, tile + to.step + lanes);
    hn::StoreU(c0, d, tile + 2 * to.step);
    hn::StoreU(c1, d, tile + 2 * to.step + lanes);
    hn::StoreU(e0, d, tile + 3 * to.step);
    hn::StoreU(e1, d, tile + 3 * to.step + lanes);
  }
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(subtract_products);

void scale(double* values, std::size_t count, double factor) noexcept {
  for (std::size_t j = 0; j < count; ++j) values[j] *= factor;
}

void subtract(double* to, const double* values, std::size_t count, double factor) noexcept {
  for (std::size_t j = 0; j < count; ++j) to[j] -= factor * values[j];
}

// In eight sums side by side: the processor does not wait for one addition before the next.
double dot(const double* a, const double* b, std::size_t count) noexcept {
  constexpr std::size_t kSums = 8;
  std::array<double, kSums> sums{};
  std::size_t j = 0;
  for (; j + kSums <= count; j += kSums)
    for (std::size_t k = 0; k < kSums; ++k) sums[k] += a[j + k] * b[j + k];
  for (; j < count; ++j) sums[j % kSums] += a[j] * b[j];
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

double root_of_pivot(double pivot) {
  if (!(pivot > 0)) throw Error("least squares: expected a positive definite matrix");
  return std::sqrt(pivot);
}

std::size_t rounded_up(std::size_t n, std::size_t step) noexcept {
  return (n + step - 1) / step * step;
}

}  // namespace

BorderedBand::BorderedBand(std::size_t count, std::size_t band, std::size_t border)
    : count_(count),
      band_(band),
      border_(border),
      stride_(kFront + band + 1 + kBack),
      border_stride_(rounded_up(border, kTile)),
      band_values_(rounded_up(count, kRows) * stride_ + kBack),
      border_values_(rounded_up(count, kRows) * border_stride_),
      corner_(border_stride_ * border_stride_) {
  static_assert(kRows == kRowsTogether && kTile == kMaxEntries);
}

void BorderedBand::factor() {
  const std::size_t next = stride_ - 1;  // from an entry to the one below it
  for (std::size_t i = 0; i < count_; i += kRows) {
    // the rows of before are in the band from each tile's first column
    for (std::size_t j = i; j < i + kRows + band_; j += kTile) {
      const std::size_t from = j > band_ ? j - band_ : 0;
      if (from < i) HWY_DYNAMIC_DISPATCH(subtract_products)
      ({in_band(i, j), next}, kTile, {in_band(from, i), next}, {in_band(from, j), next}, i - from);
    }
    const std::size_t from = i > band_ ? i - band_ : 0;
    HWY_DYNAMIC_DISPATCH(subtract_products)
    ({beside(i, 0), border_stride_}, border_, {in_band(from, i), next}, {beside(from, 0), border_stride_},
     i - from);
    finish_rows(i);
  }
  for (std::size_t i = 0; i < border_; i += kRows) {
    const Rows to{in_corner(i, 0), border_stride_};
    HWY_DYNAMIC_DISPATCH(subtract_products)
    (to, border_, {beside(0, i), border_stride_}, {beside(0, 0), border_stride_}, count_);
    HWY_DYNAMIC_DISPATCH(subtract_products)
    (to, border_, {in_corner(0, i), border_stride_}, {in_corner(0, 0), border_stride_}, i);
    finish_corner(i);
  }
}

// Rows from which those before them are subtracted, by each other.
void BorderedBand::finish_rows(std::size_t first) {
  for (std::size_t i = first; i < std::min(first + kRows, count_); ++i) {
    const double factor = 1 / root_of_pivot(*in_band(i, i));
    scale(in_band(i, i), band_ + 1, factor);
    scale(beside(i, 0), border_, factor);
    for (std::size_t below = i + 1; below < std::min({first + kRows, count_, i + band_ + 1}); ++below) {
      const double each = *in_band(i, below);
      subtract(in_band(below, below), in_band(i, below), band_ + 1 - (below - i), each);
      subtract(beside(below, 0), beside(i, 0), border_, each);
    }
  }
}

void BorderedBand::finish_corner(std::size_t first) {
  for (std::size_t i = first; i < std::min(first + kRows, border_); ++i) {
    scale(in_corner(i, i), border_ - i, 1 / root_of_pivot(*in_corner(i, i)));
    for (std::size_t below = i + 1; below < std::min(first + kRows, border_); ++below)
      subtract(in_corner(below, below), in_corner(i, below), border_ - below, *in_corner(i, below));
  }
}

void BorderedBand::solve(std::span<double> right) const noexcept {
  double *const x = right.data(), *const y = x + count_;
  // the factor's transpose, row by row
  for (std::size_t i = 0; i < count_; ++i) {
    x[i] /= *in_band(i, i);
    subtract(x + i + 1, in_band(i, i + 1), std::min(band_, count_ - 1 - i), x[i]);
    subtract(y, beside(i, 0), border_, x[i]);
  }
  for (std::size_t i = 0; i < border_; ++i) {
    y[i] /= *in_corner(i, i);
    subtract(y + i + 1, in_corner(i, i + 1), border_ - 1 - i, y[i]);
  }
  // the factor
  for (std::size_t i = border_; i-- > 0;)
    y[i] = (y[i] - dot(in_corner(i, i + 1), y + i + 1, border_ - 1 - i)) / *in_corner(i, i);
  for (std::size_t i = count_; i-- > 0;) {
    const std::size_t after = std::min(band_, count_ - 1 - i);
    x[i] -= dot(beside(i, 0), y, border_) + dot(in_band(i, i + 1), x + i + 1, after);
    x[i] /= *in_band(i, i);
  }
}

}  // namespace burnish
#endif
