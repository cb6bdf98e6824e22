// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include <burnish/math/angles.h>

namespace burnish {

/// Gauss-Legendre rule of N nodes on [-1, 1], exact for polynomials of degree 2 N - 1.
template <int N>
struct GaussLegendre {
  std::array<double, N> node;
  std::array<double, N> weight;
};

/// The rule, computed at the first call: Newton's iteration on the Legendre polynomial. Nodes and weights are
/// good to 1e-14.
template <int N>
const GaussLegendre<N>& gauss_legendre() noexcept {
  static const GaussLegendre<N> rule = [] {
    GaussLegendre<N> r;
    for (int i = 0; i < N; ++i) {
      double x = std::cos(kPi * (i + 0.75) / (N + 0.5)), slope = 0;
      for (int step = 0; step < 6; ++step) {
        double p = 1, before = 0;
        for (int k = 1; k <= N; ++k) {
          const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
          before = p;
          p = next;
        }
        slope = N * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      const auto at = static_cast<std::size_t>(i);
      r.node[at] = x;
      r.weight[at] = 2 / ((1 - x * x) * slope * slope);
    }
    return r;
  }();
  return rule;
}

/// Integral of `integrand` over [lo, hi] by N nodes; 0 where the interval is empty (hi <= lo).
template <int N, class Integrand>
double integrate(double lo, double hi, const Integrand& integrand) noexcept {
  if (!(hi > lo)) return 0;
  const GaussLegendre<N>& rule = gauss_legendre<N>();
  const double half = 0.5 * (hi - lo), middle = 0.5 * (hi + lo);
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) sum += rule.weight[i] * integrand(middle + half * rule.node[i]);
  return half * sum;
}

}  // namespace burnish
