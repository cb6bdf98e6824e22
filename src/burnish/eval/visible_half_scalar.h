// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <burnish/eval/visible_half_map.h>

namespace burnish {

/// The tables and numbers that the formulas of visible_half-inl.h read.
struct SamplerView : VisibleHalfMap {
  int thetas = 0, phis = 0, rows = 0, columns = 0;
  double theta_scale = 0,
         last_ring = 0;  ///< rings per t / (kRingReach - t), t = tan(theta_o / 2); thetas - 1
  double turn_per_row = 0, per_column = 0;  ///< turn of a row, 2 in all if isotropic, else 4; 1 / columns
  double cells = 0;                         ///< cells_per_unit
  const std::uint16_t *row_edges = nullptr, *cell_edges = nullptr;
};

/// The formulas in double, for densities and as the reference for draws in float.
namespace scalar {

using std::abs;
using std::max;
using std::min;
using std::sqrt;

// Comparisons are computed as bits: their results are nearly random, and branches would be mispredicted.
typedef double DoubleLanes __attribute__((vector_size(16)));
typedef std::int64_t MaskLanes __attribute__((vector_size(16)));

inline MaskLanes less_or_equal(double a, double b) noexcept {
  return DoubleLanes{a, a} <= DoubleLanes{b, b};
}
inline double if_true(MaskLanes mask, double a, double b) noexcept {
  return (mask ? DoubleLanes{a, a} : DoubleLanes{b, b})[0];
}
inline std::int32_t if_true(MaskLanes mask, std::int32_t a, std::int32_t b) noexcept {
  return mask[0] ? a : b;
}
inline double copy_sign(double size, double sign) noexcept {
  return std::copysign(size, sign);
}
inline std::int32_t to_int(double x) noexcept {
  return static_cast<std::int32_t>(std::abs(x) < 1e9 ? x : 0);  // not-a-number: 0
}
inline double to_real(std::int32_t i) noexcept {
  return i;
}
inline std::int32_t next_around(std::int32_t i, int last) noexcept {
  return i < last ? i + 1 : 0;
}
// Counts the edges up to the target. It works in float, as all draws do; a target that rounding moves to the
// neighbouring cell lands on its border.
template <int kSlices>
inline __attribute__((always_inline)) std::int32_t search(const std::uint16_t* table,
                                                          const std::int32_t (&start)[kSlices],
                                                          const double (&weight)[kSlices], int count,
                                                          double target) noexcept {
  const std::uint16_t* row[kSlices];
  float share[kSlices];
  for (int s = 0; s < kSlices; ++s) {
    row[s] = table + start[s];
    share[s] = static_cast<float>(weight[s]);
  }
  const auto limit = static_cast<float>(target);
  const int eights = count & ~7;  // all of them, so that vectors leave no rest
  std::int32_t below = 0;
  for (int i = 0; i < eights; ++i) {
    float edge = share[0] * static_cast<float>(row[0][i]);
    for (int s = 1; s < kSlices; ++s) edge += share[s] * static_cast<float>(row[s][i]);
    below += edge <= limit;
  }
  return below - 1;
}
struct EdgePair {
  std::int32_t lower, mass;
};
inline EdgePair edge_pair(const std::uint16_t* table, std::int32_t i) noexcept {
  return {table[i], static_cast<std::uint16_t>(table[i + 1] - table[i])};
}

#define SAMPLER_INLINE inline
#include <burnish/eval/visible_half-inl.h>
#undef SAMPLER_INLINE

}  // namespace scalar
}  // namespace burnish
