#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <burnish/fitting/aligned_vector.h>
#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/math/highway_targets.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "burnish/fitting/baselines/nonnegative_factors.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef BURNISH_FITTING_NONNEGATIVE_FACTORS
#define BURNISH_FITTING_NONNEGATIVE_FACTORS
namespace burnish {
namespace {

constexpr std::size_t kMostLanes = 16, kBlock = 4;  // floats of a vector, terms at a time

/// Factors on their way, for one row of the matrix: what it is multiplied with and made of. Lines of values
/// along the columns are `stride` long, 0 beyond the columns.
struct Row {
  std::size_t stride, terms;
  const float *weights, *weighted;  ///< weighted: weight * entry
  float* u;                         ///< [term]
  const float* v;                   ///< [term][column]
  float* fitted;                    ///< [column], weight * (u v)
  float *wanted_v, *found_v;        ///< [term][column], sums over the rows
  float least;
};

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;
using Vector = hn::Vec<Tag>;

// Calls body<count>(first) for terms [first, first + count), at most kBlock at a time.
template <class Body>
void for_each_block(std::size_t terms, const Body& body) {
  std::size_t first = 0;
  for (; first + kBlock <= terms; first += kBlock) body.template operator()<kBlock>(first);
  if (terms - first == 3) body.template operator()<3>(first);
  if (terms - first == 2) body.template operator()<2>(first);
  if (terms - first == 1) body.template operator()<1>(first);
}

void fit(const Row& row) {
  const Tag d;
  for_each_block(row.terms, [&]<std::size_t count>(std::size_t first) {
    Vector u[count];
    for (std::size_t k = 0; k < count; ++k) u[k] = hn::Set(d, row.u[first + k]);
    const bool last = first + count == row.terms;
    for (std::size_t c = 0; c < row.stride; c += hn::Lanes(d)) {
      Vector sum = first > 0 ? hn::Load(d, row.fitted + c) : hn::Zero(d);
      for (std::size_t k = 0; k < count; ++k)
        sum = hn::MulAdd(u[k], hn::Load(d, row.v + (first + k) * row.stride + c), sum);
      if (last) sum = hn::Mul(sum, hn::Load(d, row.weights + c));
      hn::Store(sum, d, row.fitted + c);
    }
  });
}

// Improves u, then adds what v needs from this row. [Lee 2001, eq. 4]
void update(const Row& row) {
  const Tag d;
  fit(row);
  for_each_block(row.terms, [&]<std::size_t count>(std::size_t first) {
    Vector wanted[count], found[count];
    for (std::size_t k = 0; k < count; ++k) wanted[k] = found[k] = hn::Zero(d);
    for (std::size_t c = 0; c < row.stride; c += hn::Lanes(d)) {
      const Vector weighted = hn::Load(d, row.weighted + c), fitted = hn::Load(d, row.fitted + c);
      for (std::size_t k = 0; k < count; ++k) {
        const Vector v = hn::Load(d, row.v + (first + k) * row.stride + c);
        wanted[k] = hn::MulAdd(weighted, v, wanted[k]);
        found[k] = hn::MulAdd(fitted, v, found[k]);
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      const float sum = hn::GetLane(hn::SumOfLanes(d, found[k]));
      float& u = row.u[first + k];
      if (sum > 0) u = std::max(row.least, u * hn::GetLane(hn::SumOfLanes(d, wanted[k])) / sum);
    }
  });
  fit(row);
  for_each_block(row.terms, [&]<std::size_t count>(std::size_t first) {
    Vector u[count];
    for (std::size_t k = 0; k < count; ++k) u[k] = hn::Set(d, row.u[first + k]);
    for (std::size_t c = 0; c < row.stride; c += hn::Lanes(d)) {
      const Vector weighted = hn::Load(d, row.weighted + c), fitted = hn::Load(d, row.fitted + c);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = (first + k) * row.stride + c;
        hn::Store(hn::MulAdd(u[k], weighted, hn::Load(d, row.wanted_v + at)), d, row.wanted_v + at);
        hn::Store(hn::MulAdd(u[k], fitted, hn::Load(d, row.found_v + at)), d, row.found_v + at);
      }
    }
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(update);

}  // namespace

LowRank nonnegative_factors(const Matrix& m, std::span<const double> weights, std::size_t terms,
                            int iterations, std::uint64_t seed) {
  assert(weights.size() == m.values.size());
  // vectors run along the longer side, called columns here
  const bool tall = m.rows > m.columns;
  const std::size_t rows = std::min(m.rows, m.columns), columns = std::max(m.rows, m.columns),
                    stride = chunk_count(columns, kMostLanes) * kMostLanes, kept = std::min(terms, rows);
  AlignedVector<float> weight(rows * stride), weighted(rows * stride), fitted(stride);
  double mean = 0, largest = std::numeric_limits<double>::min();
  for (const double w : weights) largest = std::max(largest, w);
  for (std::size_t i = 0; i < m.values.size(); ++i) {
    const std::size_t r = i / m.columns, c = i % m.columns, at = tall ? c * stride + r : r * stride + c;
    weight[at] = static_cast<float>(weights[i] / largest);
    weighted[at] = static_cast<float>(weights[i] / largest * m.values[i]);
    mean += m.values[i] / static_cast<double>(m.values.size());
  }
  const double level = std::sqrt(std::max(mean, 1e-300) / static_cast<double>(kept));
  const auto least = static_cast<float>(1e-15 * level);  // no subnormal numbers, no 0 that could never rise
  Pcg32 random(seed);
  const auto start = [&] { return static_cast<float>(level * (0.5 + random.uniform())); };
  AlignedVector<float> u(rows * kept), v(kept * stride), wanted(v.size()), found(v.size());
  std::ranges::generate(u, start);
  for (std::size_t k = 0; k < kept; ++k) std::generate_n(v.data() + k * stride, columns, start);

  for (int i = 0; i < iterations; ++i) {
    std::ranges::fill(wanted, 0.0f);
    std::ranges::fill(found, 0.0f);
    for (std::size_t r = 0; r < rows; ++r) HWY_DYNAMIC_DISPATCH(update)
    ({.stride = stride,
      .terms = kept,
      .weights = weight.data() + r * stride,
      .weighted = weighted.data() + r * stride,
      .u = u.data() + r * kept,
      .v = v.data(),
      .fitted = fitted.data(),
      .wanted_v = wanted.data(),
      .found_v = found.data(),
      .least = least});
    for (std::size_t j = 0; j < v.size(); ++j)
      if (found[j] > 0) v[j] = std::max(least, v[j] * wanted[j] / found[j]);
  }

  LowRank result{kept, std::vector<double>(u.begin(), u.end()), std::vector<double>(columns * kept)};
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t k = 0; k < kept; ++k) result.v[c * kept + k] = v[k * stride + c];
  if (tall) std::swap(result.u, result.v);
  return result;
}

}  // namespace burnish
#endif
