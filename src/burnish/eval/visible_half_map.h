// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/reflectance/half_vector_quadrature.h>

namespace burnish {

/// Maps the half vectors that are visible from some wo to a rectangle, which holds the cells of a sampling table.
/// With m = tan^2(theta_h / 2), along every azimuth
///   G(m) = share (1 + K) m / (m + K) + (1 - share) m.
/// The first term is a highlight of width sqrt(K), the second the whole hemisphere. The rectangle's v is G(m) /
/// G(largest visible m). Its u is the azimuth in the metric |x'| + |y'| of the vector (x', y') = M (cos phi, sin
/// phi), which needs no trigonometry. If M stretches, K = sharpness / |(x', y')|^2. For isotropic BRDFs the azimuth
/// is counted from that of wo, and half the circle is enough. Both directions of the map are closed forms
/// (eval/visible_half-inl.h).
struct VisibleHalfMap {
  double sharpness = 0.01, share = 0.5;
  double xx = 1, xy = 0, yy = 1;  ///< M, symmetric, determinant 1

  friend bool operator==(const VisibleHalfMap&, const VisibleHalfMap&) = default;
};

/// The light that a BRDF reflects towards one wo.
struct ReflectedLight {
  Vec3 wo;
  std::vector<DirectionWeight> rule;
  std::vector<double> size;  ///< reflected_size at the rule's directions
};

/// Finds the map that gives weights f cos / pdf the least relative second moment, as the mean of its logarithms over
/// the views. The map has `rows` by `columns` cells with optimal masses. The search is deterministic, and the same on
/// every machine to rounding.
VisibleHalfMap fit_visible_half_map(const std::vector<ReflectedLight>& views, bool isotropic, int rows,
                                    int columns);

}  // namespace burnish
