// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace burnish {

/// Formulas of prefiltered light, once for double and once for expression graphs. V is a vector of numbers T,
/// with members x, y and z.

/// The plane of view and normal is divided by no less than this sine between them.
inline constexpr double kMinSine = 1e-6;
/// Maps of a kernel: its mean and four orders of harmonics of the azimuth, a cosine and a sine each.
inline constexpr std::size_t kMaxMaps = 9;

/// Axes at right angles to `up` that turn with it without a seam where up.y > -1 [Duff 2017, with y for z].
template <class V>
struct TurnedAxes {
  V x, z;

  explicit TurnedAxes(const V& up) : TurnedAxes(up, 1 / (1 + up.y)) {}

 private:
  template <class T>
  TurnedAxes(const V& up, const T& a)
      : x{1 - up.x * up.x * a, -up.x, -up.x * up.z * a}, z{-up.x * up.z * a, -up.z, 1 - up.z * up.z * a} {}
};

/// A kernel's axis at `angle` from the normal n in the plane of view and normal, and the tilt that its azimuth
/// counts from. `plane` points away from the viewer at right angles to n.
template <class V>
struct KernelAxis {
  V axis, tilt;
};
template <class V, class T>
KernelAxis<V> kernel_axis(const V& n, const V& plane, const T& angle) {
  using std::cos, std::sin;
  return {cos(angle) * n + sin(angle) * plane, cos(angle) * plane - sin(angle) * n};
}

/// 1, then cos and sin of multiples of the azimuth whose cosine and sine are given.
template <std::size_t kMaps, class T>
std::array<T, kMaps> harmonics(const T& c, const T& s) {
  std::array<T, kMaps> h{T(1.0), c, s};
  for (std::size_t i = 3; i < kMaps; i += 2) {
    h[i] = c * h[i - 2] - s * h[i - 1];
    h[i + 1] = s * h[i - 2] + c * h[i - 1];
  }
  return h;
}

/// Returns the place of a direction with y >= 0 in its parabolic map of `side` texels a side, in texels.
template <class T>
struct MapPlace {
  T x, y;
};
template <class V>
auto map_place(const V& w, int side) {
  using T = decltype(w.x);
  const T scale = 0.5 * (side - 1) / (1 + w.y);
  return MapPlace<T>{w.x * scale + 0.5 * (side - 1), w.z * scale + 0.5 * (side - 1)};
}

}  // namespace burnish
