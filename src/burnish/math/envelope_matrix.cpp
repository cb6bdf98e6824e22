#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/envelope_matrix.h>

#define HWY_TARGET_INCLUDE "burnish/math/envelope_matrix.cpp"
#include <burnish/math/highway-inl.h>

#ifndef BURNISH_MATH_ENVELOPE_MATRIX
#define BURNISH_MATH_ENVELOPE_MATRIX
namespace burnish {
namespace {

constexpr std::size_t kSums = 4, kDots = 4;

// A dot product of which the first entries are in four sums side by side: the processor does not wait for one addition
// before the next.
struct PartialDot {
  const double *a, *b;
  std::array<double, kSums> sums{};
};

}  // namespace
}  // namespace burnish
#endif

BURNISH_BEGIN_TARGET;

// The first `count` entries of each, a multiple of kSums; the same bits as PartialDot's alone.
void add_entries(std::array<PartialDot, kDots>& dots, std::size_t count) {
  const hn::CappedTag<double, kSums> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d), kVectors = kSums / kLanes;
  hn::Vec<decltype(d)> sums[kDots][kVectors];
  for (auto& dot : sums)
    for (auto& sum : dot) sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += kSums)
    for (std::size_t k = 0; k < kDots; ++k)
      for (std::size_t v = 0; v < kVectors; ++v) {
        const std::size_t at = i + v * kLanes;
        sums[k][v] = hn::Add(sums[k][v], hn::Mul(hn::LoadU(d, dots[k].a + at), hn::LoadU(d, dots[k].b + at)));
      }
  for (std::size_t k = 0; k < kDots; ++k)
    for (std::size_t v = 0; v < kVectors; ++v) hn::StoreU(sums[k][v], d, dots[k].sums.data() + v * kLanes);
}

BURNISH_END_TARGET;

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(add_entries);

// With the entries from i to n.
double finished(const PartialDot& dot, std::size_t i, std::size_t n) noexcept {
  const auto [a, b, sums] = dot;
  auto [s0, s1, s2, s3] = sums;
  for (; i + kSums <= n; i += kSums) {
    s0 += a[i] * b[i];
    s1 += a[i + 1] * b[i + 1];
    s2 += a[i + 2] * b[i + 2];
    s3 += a[i + 3] * b[i + 3];
  }
  for (; i < n; ++i) s0 += a[i] * b[i];
  return (s0 + s1) + (s2 + s3);
}

double dot(const double* a, const double* b, std::size_t n) noexcept {
  return finished({a, b}, 0, n);
}

}  // namespace

EnvelopeMatrix::EnvelopeMatrix(std::vector<std::size_t> first) : first_(std::move(first)) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    begin_.push_back(count);
    count += i - first_[i] + 1;
  }
  values_.resize(count);
}

void EnvelopeMatrix::factor() {
  for (std::size_t i = 0; i < size(); ++i) {
    double* const own = values_.data() + begin_[i];
    for (std::size_t block = first_[i]; block <= i; block += kDots) {
      // of the block's products what the row has already, together; an entry needs those before it
      std::array<PartialDot, kDots> dots;
      std::array<std::size_t, kDots> counts;
      const std::size_t entries = std::min(kDots, i + 1 - block);
      std::size_t known = entries == kDots ? block : 0;
      for (std::size_t k = 0; k < entries; ++k) {
        const std::size_t j = block + k, from = std::max(first_[i], first_[j]);
        dots[k] = {own + (from - first_[i]), row(j) + (from - first_[j])};
        counts[k] = j - from;
        known = std::min(known, from < block ? block - from : 0);
      }
      known -= known % kSums;
      if (known > 0) HWY_DYNAMIC_DISPATCH(add_entries)(dots, known);
      for (std::size_t k = 0; k < entries; ++k) {
        const std::size_t j = block + k;
        double& entry = own[j - first_[i]];
        entry -= finished(dots[k], known, counts[k]);
        if (j < i) {
          entry /= row(j)[j - first_[j]];
        } else {
          if (!(entry > 0)) throw Error("least squares: expected a positive definite matrix");
          entry = std::sqrt(entry);
        }
      }
    }
  }
}

void EnvelopeMatrix::solve(std::span<double> right) const noexcept {
  for (std::size_t i = 0; i < size(); ++i)
    right[i] = (right[i] - dot(row(i), right.data() + first_[i], i - first_[i])) / row(i)[i - first_[i]];
  for (std::size_t i = size(); i-- > 0;) {
    right[i] /= row(i)[i - first_[i]];
    for (std::size_t j = first_[i]; j < i; ++j) right[j] -= row(i)[j - first_[i]] * right[i];
  }
}

}  // namespace burnish
#endif
