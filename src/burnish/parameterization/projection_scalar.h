// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <burnish/parameterization/hemisphere_map.h>
#include <burnish/parameterization/projection.h>

/// The formulas of projection-inl.h for double: the definition. Files that include this are compiled without
/// contraction to fused multiply-adds (CMakeLists.txt).
namespace burnish::definition {

using burnish::mirror;
using std::abs;
using std::max;
using std::min;
using std::sqrt;

inline double mul_add(double a, double b, double c) noexcept {
  return a * b + c;
}
inline double neg_mul_add(double a, double b, double c) noexcept {
  return c - a * b;
}
inline double if_less(double a, double b, double x, double y) noexcept {
  return a < b ? x : y;
}
inline double power(double t, double exponent) noexcept {
  return std::pow(t, exponent);
}
inline double length(double x, double y) noexcept {
  return std::sqrt(x * x + y * y);
}
inline double length(double x, double y, double z) noexcept {
  return std::sqrt(x * x + y * y + z * z);
}
inline double least_positive(double) noexcept {
  return std::numeric_limits<double>::min();
}
template <class T>
T named(const char*, T x) noexcept {
  return x;
}

#define FORMULA_INLINE inline
#define FORMULA_ATTRIBUTE
#include <burnish/parameterization/projection-inl.h>
#undef FORMULA_ATTRIBUTE
#undef FORMULA_INLINE

/// Two directions for the formulas.
struct Pair {
  Vec3 sum, apart;

  Pair(Vec3 wi, Vec3 wo) noexcept : sum(wi + wo), apart(wi - wo) {}
  double sum_length() const noexcept { return length(sum.x, sum.y, sum.z); }
};

/// warp.forward(t), by the formula.
inline double forward(const Warp& warp, double t) noexcept {
  const Polar<double> polar{t, 1};
  switch (warp.kind) {
    case WarpKind::rational:
      return rational_warp(1.0, warp.parameter, polar);
    case WarpKind::power:
      return power_warp(1.0, warp.parameter, polar);
    case WarpKind::identity:
      break;
  }
  return identity_warp(1.0, polar);
}

}  // namespace burnish::definition
