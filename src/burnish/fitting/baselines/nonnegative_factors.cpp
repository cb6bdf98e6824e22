// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/fitting/numerics/aligned_vector.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>

#define HWY_TARGET_INCLUDE "burnish/fitting/baselines/nonnegative_factors.cpp"
#include <burnish/math/highway-inl.h>

#ifndef BURNISH_FITTING_NONNEGATIVE_FACTORS
#define BURNISH_FITTING_NONNEGATIVE_FACTORS
namespace burnish {
namespace {

constexpr std::size_t kMaxLanes = 16, kBlock = 4;  // floats of a vector, terms at a time

// [Lee 2001, eq. 4]
float improved(float x, float wanted, float found, float least) {
  return found > 0 ? std::max(least, x * wanted / found) : x;
}

/// One row of the matrix and what meets it. Lines along the columns are `stride` long, weightless beyond
/// them.
struct Row {
  std::size_t stride, terms;
  bool improve_near, gather_far;    ///< what is done
  const float *weights, *weighted;  ///< weighted: weight * entry
  float* near;                      ///< [term], of this row
  const float* far;                 ///< [term][column]
  float* fitted;                    ///< [column], weight * sum of near * far
  float *wanted, *found;            ///< [term][column], sums over the rows that improve far
  float least;
};

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

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
  for_each_block(row.terms, [&]<std::size_t count>(std::size_t first) HWY_ATTR {
    Vector near[count];
    for (std::size_t k = 0; k < count; ++k) near[k] = hn::Set(d, row.near[first + k]);
    const bool last = first + count == row.terms;
    for (std::size_t c = 0; c < row.stride; c += hn::Lanes(d)) {
      Vector sum = first > 0 ? hn::Load(d, row.fitted + c) : hn::Zero(d);
      for (std::size_t k = 0; k < count; ++k)
        sum = hn::MulAdd(near[k], hn::Load(d, row.far + (first + k) * row.stride + c), sum);
      if (last) sum = hn::Mul(sum, hn::Load(d, row.weights + c));
      hn::Store(sum, d, row.fitted + c);
    }
  });
}

void improve_near(const Row& row) {
  const Tag d;
  for_each_block(row.terms, [&]<std::size_t count>(std::size_t first) HWY_ATTR {
    Vector wanted[count], found[count];
    for (std::size_t k = 0; k < count; ++k) wanted[k] = found[k] = hn::Zero(d);
    for (std::size_t c = 0; c < row.stride; c += hn::Lanes(d)) {
      const Vector weighted = hn::Load(d, row.weighted + c), fitted = hn::Load(d, row.fitted + c);
      for (std::size_t k = 0; k < count; ++k) {
        const Vector far = hn::Load(d, row.far + (first + k) * row.stride + c);
        wanted[k] = hn::MulAdd(weighted, far, wanted[k]);
        found[k] = hn::MulAdd(fitted, far, found[k]);
      }
    }
    for (std::size_t k = 0; k < count; ++k)
      row.near[first + k] = improved(row.near[first + k], hn::GetLane(hn::SumOfLanes(d, wanted[k])),
                                     hn::GetLane(hn::SumOfLanes(d, found[k])), row.least);
  });
}

void gather_far(const Row& row) {
  const Tag d;
  for_each_block(row.terms, [&]<std::size_t count>(std::size_t first) HWY_ATTR {
    Vector near[count];
    for (std::size_t k = 0; k < count; ++k) near[k] = hn::Set(d, row.near[first + k]);
    for (std::size_t c = 0; c < row.stride; c += hn::Lanes(d)) {
      const Vector weighted = hn::Load(d, row.weighted + c), fitted = hn::Load(d, row.fitted + c);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = (first + k) * row.stride + c;
        hn::Store(hn::MulAdd(near[k], weighted, hn::Load(d, row.wanted + at)), d, row.wanted + at);
        hn::Store(hn::MulAdd(near[k], fitted, hn::Load(d, row.found + at)), d, row.found + at);
      }
    }
  });
}

void visit(const Row& row) {
  fit(row);
  if (row.improve_near) {
    improve_near(row);
    if (row.gather_far) fit(row);
  }
  if (row.gather_far) gather_far(row);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(visit);

constexpr float kStill = 1e-5f;  // relative change of values that have arrived, far below a half float's

/// A matrix row by row along its longer side, with its weights, each row filled up to `stride`.
struct WeightedRows {
  std::size_t stride;
  AlignedVector<float> weights, weighted;  ///< over the largest weight; times the values
  double mean;                             ///< of the values, > 0
};

WeightedRows lay_out(const Matrix& m, std::span<const double> weights, bool tall) {
  const std::size_t rows = std::min(m.rows, m.columns), columns = std::max(m.rows, m.columns),
                    stride = chunk_count(columns, kMaxLanes) * kMaxLanes;
  WeightedRows result{.stride = stride,
                      .weights = AlignedVector<float>(rows * stride),
                      .weighted = AlignedVector<float>(rows * stride),
                      .mean = 0};
  double sum = 0;
  const double unit = 1 / std::max(*std::ranges::max_element(weights), std::numeric_limits<double>::min());
  for (std::size_t r = 0, i = 0; r < m.rows; ++r)
    for (std::size_t c = 0; c < m.columns; ++c, ++i) {
      const std::size_t at = tall ? c * stride + r : r * stride + c;
      result.weights[at] = static_cast<float>(unit * weights[i]);
      result.weighted[at] = static_cast<float>(unit * weights[i] * m.values[i]);
      sum += m.values[i];
    }
  result.mean = std::max(sum / static_cast<double>(m.values.size()), 1e-300);
  return result;
}

}  // namespace

LowRank nonnegative_factors(const Matrix& m, std::span<const double> weights, std::size_t terms,
                            int iterations, std::uint64_t seed) {
  assert(weights.size() == m.values.size());
  // vectors run along the longer side, the far one, whose values are sums over the rows
  const bool tall = m.rows > m.columns;
  WeightedRows matrix = lay_out(m, weights, tall);
  const std::size_t rows = std::min(m.rows, m.columns), stride = matrix.stride, kept = std::min(terms, rows);

  // random factors of the matrix's level
  const double level = std::sqrt(matrix.mean / static_cast<double>(kept));
  const auto least = static_cast<float>(1e-15 * level);  // no subnormal numbers, no 0 that could never rise
  Pcg32 random(seed);
  LowRank result{kept, std::vector<double>(m.rows * kept), std::vector<double>(m.columns * kept)};
  for (std::vector<double>* side : {&result.u, &result.v})
    std::ranges::generate(*side, [&] { return level * (0.5 + random.uniform()); });
  std::vector<double>&near_side = tall ? result.v : result.u, &far_side = tall ? result.u : result.v;
  AlignedVector<float> near(near_side.begin(), near_side.end()), far(kept * stride), wanted(far.size()),
      found(far.size()), fitted(stride);
  for (std::size_t i = 0; i < far_side.size(); ++i)
    far[i % kept * stride + i / kept] = static_cast<float>(far_side[i]);

  // u, v, u, v and so on, whichever is near
  bool still = false;
  for (int i = tall ? 0 : 1; i <= iterations && !still; ++i) {
    const bool gather = !tall || i < iterations;
    std::ranges::fill(wanted, 0.0f);
    std::ranges::fill(found, 0.0f);
    for (std::size_t r = 0; r < rows; ++r) {
      const Row row{.stride = stride,
                    .terms = kept,
                    .improve_near = i > 0,
                    .gather_far = gather,
                    .weights = matrix.weights.data() + r * stride,
                    .weighted = matrix.weighted.data() + r * stride,
                    .near = near.data() + r * kept,
                    .far = far.data(),
                    .fitted = fitted.data(),
                    .wanted = wanted.data(),
                    .found = found.data(),
                    .least = least};
      HWY_DYNAMIC_DISPATCH(visit)(row);
    }
    if (!gather) break;
    float change = 0;
    for (std::size_t j = 0; j < far.size(); ++j) {
      const float before = far[j];
      far[j] = improved(before, wanted[j], found[j], least);
      change = std::max(change, std::abs(far[j] - before) - kStill * before);
    }
    still = change <= 0;
  }
  near_side.assign(near.begin(), near.end());
  for (std::size_t i = 0; i < far_side.size(); ++i) far_side[i] = far[i % kept * stride + i / kept];
  return result;
}

}  // namespace burnish
#endif
