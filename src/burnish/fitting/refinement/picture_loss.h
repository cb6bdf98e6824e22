// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace burnish {

/// The errors that refinement weighs, each a mean over its part of the training set; or one number for each.
struct ErrorTerms {
  /// The squared error of min(1, exposure f cos theta_i)^(1/2.2) over pixels, as the sphere images are scored.
  double pictures = 0;
  /// The same at 1/8 and 1/64 of the exposure, so that highlights keep their shape.
  double dimmed = 0;
  double relative = 0;  ///< of pairs, |ln((f + 1e-3) / (f^ + 1e-3))|
  double log_cos = 0;   ///< of pairs, |ln(1 + f cos theta_i) - ln(1 + f^ cos theta_i)|
  double absolute = 0;  ///< of pairs, (f - f^)^2, 1/sr^2: highlights near grazing rule it
  double albedo = 0;    ///< of albedos, the squared relative error; see AlbedoSet

  ErrorTerms& operator+=(const ErrorTerms& other) noexcept {
    pictures += other.pictures;
    dimmed += other.dimmed;
    relative += other.relative;
    log_cos += other.log_cos;
    absolute += other.absolute;
    albedo += other.albedo;
    return *this;
  }

  /// Returns the sum of all terms except albedo.
  double sum() const noexcept { return pictures + dimmed + relative + log_cos + absolute; }
};

/// The objective of refinement: the sum of share ln(mean) over the terms. So a percent of one error is worth a
/// percent of another, whatever their sizes. Absolute values are rounded off near 0.
/// The noise of a measurement about small values, negative ones among them, weighs little in all terms but that of
/// albedos. These are linear in the raw values and so keep the model from reflecting more than was measured.
struct PictureLoss {
  static constexpr double kInverseGamma = 1 / 2.2;
  static constexpr double kFloor = 1e-3;  ///< 1/sr, of `relative`
  /// Absolute errors below these count as squares; errors of sensors and rounding lie below.
  static constexpr double kRelativeRound = 0.05, kLogCosRound = 0.003;
  /// Factors of a shown pixel at the three exposures: one gamma for all, as (e y)^g = e^g y^g.
  static inline const std::array<double, 3> kDim{1, std::pow(1.0 / 8, kInverseGamma),
                                                 std::pow(1.0 / 64, kInverseGamma)};
  /// The slope of a saturated pixel's model where the reference is not saturated, relative to the slope at 1.
  static constexpr double kSaturatedSlope = 0.3;

  ErrorTerms shares{.pictures = 2, .dimmed = 0.1, .relative = 1, .log_cos = 1};
  double exposure = 1;

  /// Returns the objective for given means.
  double objective(const ErrorTerms& means) const noexcept;

  /// The part of a value's errors that does not depend on the model. For a pixel it is (exposure f cos
  /// theta_i)^(1/2.2), for a pair ln(f + 1e-3) and ln(1 + f cos theta_i).
  struct Target {
    float first = 0, second = 0;
  };
  Target target(double f, double cos_theta_i, bool picture) const noexcept;

  /// Slope and Gauss-Newton curvature of one value's part in the objective by ln f^, given the derivative of
  /// the objective by each term's sum; adds the value's errors times `weight` to `sums`.
  struct Slope {
    double gradient = 0, curvature = 0;
  };
  Slope add(Target target, double model, double cos_theta_i, bool picture, double weight,
            const ErrorTerms& derivatives, ErrorTerms& sums) const noexcept;

  /// Returns the derivative of the objective by each term's sum, given the means and the sums of weights.
  ErrorTerms derivatives(const ErrorTerms& means, double picture_weight, double pair_weight,
                         double albedo_count = 0) const noexcept;
};

}  // namespace burnish
