// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/kriged_nodes.h>

namespace burnish {

/// The figure `relative` that a model is expected to have against the truth behind measured points. At a pair, ln of
/// truth over model is taken as normal: its mean is ln(function / model), its deviation KrigedNodes::uncertainty.
/// The figure is exp(mean |ln|) - 1, over those of 2,000 pairs of draw_pairs that have both cosines above 0.15.
struct ExpectedError {
  static constexpr double kBandDegrees = 15;
  /// The least theta_i of a band.
  static constexpr double begin_degrees(std::size_t band) noexcept {
    return kBandDegrees * static_cast<double>(band);
  }

  double relative = 0;
  /// The errors of pairs whose theta_i lies in [0, 15), [15, 30), ... degrees; nothing where no pair does.
  std::array<std::optional<double>, 6> by_theta_i;
};

/// Returns the expected error of a model. One channel serves for each of the other side's. Throws Error if both have
/// several channels, and not as many.
ExpectedError expected_error(const KrigedNodes& function, BrdfRef model);

}  // namespace burnish
