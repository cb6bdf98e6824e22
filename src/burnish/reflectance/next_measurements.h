// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// Most directions that are listed.
inline constexpr std::size_t kMostNext = 800;

/// Directions that are worth a measurement.
struct NextMeasurement {
  DirectionPair pair;  ///< of an isotropic source with wi at phi = 0, wo at phi in [0, pi]
  double error = 0;    ///< the standard deviation of ln(f + 1e-3) there, once those before it are measured
};

/// Directions to measure next: of kMostNext pairs drawn as draw_pairs does, one after the other that which lowers the
/// expected error most, the mean standard deviation of ln f over 400 other such pairs. Expected errors depend on where is
/// measured, not on what is found there, so all can be measured in one go. Pairs have both cosines above 0.15, as those
/// that node_figures judges. Fewer where `count` is more than are tried. Throws Error as KrigedNodes. Deterministic.
/// Source: greedy as in [Krause 2008], for the mean error in place of information.
std::vector<NextMeasurement> next_measurements(const MeasuredNodes& nodes, const LogCovariance& covariance,
                                               std::size_t count);

}  // namespace burnish
