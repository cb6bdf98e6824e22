// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/fitting/refinement/picture_loss.h>

namespace burnish {

namespace {

// Added to the means in the objective: errors below these do not matter, and ln stays finite.
constexpr ErrorTerms kNegligible{
    .pictures = 1e-7, .dimmed = 1e-7, .relative = 1e-4, .log_cos = 1e-5, .absolute = 1e-8, .albedo = 3e-5};

// A smooth absolute value, which is `round` at 0.
double rounded_abs(double error, double round) noexcept {
  return std::sqrt(error * error + round * round);
}

}  // namespace

double PictureLoss::objective(const ErrorTerms& means) const noexcept {
  // The objective is the sum of share * ln(mean + negligible); albedos count as ln(1 + mean / negligible).
  return shares.pictures * std::log(means.pictures + kNegligible.pictures) +
         shares.dimmed * std::log(means.dimmed + kNegligible.dimmed) +
         shares.relative * std::log(means.relative + kNegligible.relative) +
         shares.log_cos * std::log(means.log_cos + kNegligible.log_cos) +
         shares.absolute * std::log(means.absolute + kNegligible.absolute) +
         shares.albedo * std::log1p(means.albedo / kNegligible.albedo);
}

ErrorTerms PictureLoss::derivatives(const ErrorTerms& means, double picture_weight, double pair_weight,
                                    double albedo_count) const noexcept {
  // d objective / d sum = share / (mean + negligible) / (sum of weights), as the mean is the sum over the weights.
  ErrorTerms d;
  if (picture_weight > 0) {
    d.pictures = shares.pictures / (means.pictures + kNegligible.pictures) / picture_weight;
    d.dimmed = shares.dimmed / (means.dimmed + kNegligible.dimmed) / picture_weight;
  }
  if (pair_weight > 0) {
    d.relative = shares.relative / (means.relative + kNegligible.relative) / pair_weight;
    d.log_cos = shares.log_cos / (means.log_cos + kNegligible.log_cos) / pair_weight;
    d.absolute = shares.absolute / (means.absolute + kNegligible.absolute) / pair_weight;
  }
  if (albedo_count > 0) d.albedo = shares.albedo / (means.albedo + kNegligible.albedo) / albedo_count;
  return d;
}

PictureLoss::Target PictureLoss::target(double f, double cos_theta_i, bool picture) const noexcept {
  if (picture) return {static_cast<float>(std::pow(f * exposure * cos_theta_i, kInverseGamma)), 0};
  return {static_cast<float>(std::log(f + kFloor)), static_cast<float>(std::log1p(f * cos_theta_i))};
}

PictureLoss::Slope PictureLoss::add(Target target, double model, double cos_theta_i, bool picture,
                                    double weight, const ErrorTerms& derivatives,
                                    ErrorTerms& sums) const noexcept {
  Slope slope;
  if (picture) {
    // A pixel is shown at three exposures as min(1, (exposure f cos theta_i)^(1/2.2)).
    const double modelled = std::pow(model * exposure * cos_theta_i, kInverseGamma);
    for (std::size_t e = 0; e < kDim.size(); ++e) {
      const double a = target.first * kDim[e], b = modelled * kDim[e];
      if (a >= 1 && b >= 1) continue;  // Both are white here; dimmer exposures tell them apart.
      const double error = std::min(b, 1.0) - std::min(a, 1.0);
      const double derivative = e == 0 ? derivatives.pictures : derivatives.dimmed;
      const double share = (e == 0 ? 1 : 0.5) * weight;
      // d b / d ln f^ = b / gamma. A saturated model keeps a small slope, so that it can come back.
      const double rise = kInverseGamma * (b > 1 ? kSaturatedSlope : b);
      (e == 0 ? sums.pictures : sums.dimmed) += share * error * error;
      slope.gradient += share * derivative * 2 * error * rise;
      slope.curvature += share * derivative * 2 * rise * rise;
    }
    return slope;
  }
  // A rounded absolute error has the slope error / size, and the curvature of the parabola that touches it there: 1 /
  // size, as in reweighted least squares.
  const auto add_absolute = [&](double& sum, double derivative, double error, double rise, double round) {
    const double size = rounded_abs(error, round), w = weight * derivative;
    sum += weight * (size - round);
    slope.gradient += w * error / size * rise;
    slope.curvature += w * rise * rise / size;
  };
  const double lit = model * cos_theta_i;
  add_absolute(sums.relative, derivatives.relative, std::log(model + kFloor) - target.first,
               model / (model + kFloor), kRelativeRound);
  add_absolute(sums.log_cos, derivatives.log_cos, std::log1p(lit) - target.second, lit / (1 + lit),
               kLogCosRound);

  // The squared error's slope by ln f^ is 2 error f^. Its curvature takes max(f^, f) f^ in place of f^ f^, so that a
  // model far below steps by no more than the ratio.
  const double f = std::exp(static_cast<double>(target.first)) - kFloor, error = model - f;
  sums.absolute += weight * error * error;
  slope.gradient += weight * derivatives.absolute * 2 * error * model;
  slope.curvature += weight * derivatives.absolute * 2 * std::max(model, f) * model;
  return slope;
}

}  // namespace burnish
