// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <burnish/math/angles.h>
#include <burnish/math/vec3.h>

namespace burnish {

/// The shader's formulas for a quadrilateral light, written once for double and for expression graphs. V is a vector
/// of numbers T, with members x, y and z. There are no branches: an edge that is cut or gone is selected by a
/// condition.

namespace scalar_select {
inline double if_less(double a, double b, double x, double y) noexcept {
  return a < b ? x : y;
}
}  // namespace scalar_select

/// angle / sin(angle) for the cosine x in (-1, 1]. The relative error is below 5e-6 for x >= 0.
template <class T>
T angle_over_sine(const T& x) {
  using std::abs, std::max, std::sqrt, scalar_select::if_less;
  const T c = abs(x);
  T g(0.04164716763001967);
  for (const double k : {-0.19247486455895216, 0.4179156120792495, -0.6160572217490871, 0.7777224167321193,
                         -0.9995423990187383, 1.5707917009694152})
    g = g * c + k;
  const T whole = kPi / sqrt(max(T(1.0) - x * x, T(1e-7)));
  return if_less(x, T(0.0), whole - g, g);
}

/// An edge from a to b; `present` is 1 if it exists.
template <class V>
struct LitEdge {
  using T = decltype(V::x);
  V a, b;
  T present;
};

template <class V, class T>
V selected(const T& below, const T& limit, const V& x, const V& y) {
  using scalar_select::if_less;
  return V(if_less(below, limit, x.x, y.x), if_less(below, limit, x.y, y.y), if_less(below, limit, x.z, y.z));
}

/// Cuts away the part of a closed convex polygon below the horizon. The edge along the cut comes last.
template <class V>
std::vector<LitEdge<V>> edges_above(const std::vector<LitEdge<V>>& edges) {
  using T = decltype(V::x);
  using std::max, std::abs, scalar_select::if_less;
  const T zero(0.0), one(1.0);
  std::vector<LitEdge<V>> kept;
  V left(zero, zero, one), entered(zero, zero, one);
  T cut = zero;
  for (const auto& [a, b, present] : edges) {
    const T above_a = if_less(zero, a.z, present, zero), above_b = if_less(zero, b.z, present, zero);
    const T fall = a.z - b.z, t = a.z / if_less(abs(fall), T(1e-30), one, fall);
    const V at(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), zero);
    const T leaves = above_a * (one - above_b), enters = above_b * (one - above_a);
    left = selected(T(0.5), leaves, at, left);
    entered = selected(T(0.5), enters, at, entered);
    cut = max(cut, leaves);
    kept.push_back({selected(T(0.5), enters, at, a), selected(T(0.5), leaves, at, b), max(above_a, above_b)});
  }
  kept.push_back({left, entered, cut});
  return kept;
}

/// Returns the plain cosine's share of a polygon above the horizon, given by its edges.
template <class V>
auto share_of_edges(const std::vector<LitEdge<V>>& edges) {
  using T = decltype(V::x);
  using std::max, std::min, std::sqrt, std::abs, scalar_select::if_less;
  T sum(0.0);
  for (const auto& [a, b, present] : edges) {
    const T scale = T(1.0) / sqrt(max(dot(a, a) * dot(b, b), T(1e-30)));
    const T cosine = max(min(dot(a, b) * scale, T(1.0)), T(-1.0));
    sum = sum + if_less(T(0.5), present, (a.x * b.y - a.y * b.x) * scale * angle_over_sine(cosine), T(0.0));
  }
  return T(abs(sum) * (1 / kTwoPi));
}

/// Shares of a quadrilateral for the plain cosine and for transformed cosines. Corners are in order, relative to the
/// lit point.
template <class V>
class LitQuad {
 public:
  using T = decltype(V::x);

  explicit LitQuad(const std::array<V, 4>& p)
      : edges_(edges_above<V>(
            {{p[0], p[1], T(1.0)}, {p[1], p[2], T(1.0)}, {p[2], p[3], T(1.0)}, {p[3], p[0], T(1.0)}})) {}

  T cosine_share() const { return share_of_edges(edges_); }
  /// `to_cosine` maps a vector into the frame of the cosine.
  template <class Map>
  T lobe_share(const Map& to_cosine) const {
    std::vector<LitEdge<V>> edges = edges_;
    for (auto& [a, b, present] : edges) {
      a = to_cosine(a);
      b = to_cosine(b);
    }
    return share_of_edges(edges_above(edges));
  }

 private:
  std::vector<LitEdge<V>> edges_;
};

}  // namespace burnish
