#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/kriged_nodes.h>

namespace burnish {

/// How far a model of measured points is expected to be from what was measured, as the figure `relative`, whose
/// mean |ln| is that of a normal variable: about the logarithm of model over function, as wide as the function is
/// uncertain. Over 2,000 pairs of draw_pairs with both cosines above 0.15.
struct ExpectedError {
  static constexpr double kBandDegrees = 15;

  double relative = 0;
  /// Of the pairs whose theta_i lies in [0, 15), [15, 30), ... degrees; nothing where no pair does.
  std::array<std::optional<double>, 6> by_theta_i;
};

/// Throws Error if the model's channels are not as many as the function's.
ExpectedError expected_error(const KrigedNodes& function, BrdfRef model);

}  // namespace burnish
