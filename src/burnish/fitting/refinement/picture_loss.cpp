#include <algorithm>
#include <cmath>

#include <burnish/fitting/refinement/picture_loss.h>

namespace burnish {

namespace {

// Added to the means in the objective: errors below do not matter, and ln stays finite.
constexpr ErrorTerms kNegligible{1e-7, 1e-7, 1e-4, 1e-5};

double rounded_abs(double error, double round) noexcept {
  return std::sqrt(error * error + round * round);
}

}  // namespace

double PictureLoss::objective(const ErrorTerms& means) const noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < kErrorTerms; ++k) sum += shares[k] * std::log(means[k] + kNegligible[k]);
  return sum;
}

ErrorTerms PictureLoss::derivatives(const ErrorTerms& means, double picture_weight,
                                    double pair_weight) const noexcept {
  ErrorTerms d{};
  for (std::size_t k = 0; k < kErrorTerms; ++k) {
    const double weight = k < 2 ? picture_weight : pair_weight;
    if (weight > 0) d[k] = shares[k] / (means[k] + kNegligible[k]) / weight;
  }
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
    const double modelled = std::pow(model * exposure * cos_theta_i, kInverseGamma);
    for (std::size_t e = 0; e < kDim.size(); ++e) {
      const double a = target.first * kDim[e], b = modelled * kDim[e];
      if (a >= 1 && b >= 1) continue;  // white both: dimmer exposures tell them apart
      const double error = std::min(b, 1.0) - std::min(a, 1.0);
      const std::size_t term = e == 0 ? 0 : 1;
      const double share = (e == 0 ? 1 : 0.5) * weight;
      const double rise = kInverseGamma * (b > 1 ? kSaturatedSlope : b);
      sums[term] += share * error * error;
      slope.gradient += share * derivatives[term] * 2 * error * rise;
      slope.curvature += share * derivatives[term] * 2 * rise * rise;
    }
    return slope;
  }
  const auto add_absolute = [&](std::size_t term, double error, double rise, double round) {
    const double size = rounded_abs(error, round), w = weight * derivatives[term];
    sums[term] += weight * (size - round);
    slope.gradient += w * error / size * rise;
    slope.curvature += w * rise * rise / size;
  };
  const double lit = model * cos_theta_i;
  add_absolute(2, std::log(model + kFloor) - target.first, model / (model + kFloor), kRelativeRound);
  add_absolute(3, std::log1p(lit) - target.second, lit / (1 + lit), kLogCosRound);
  return slope;
}

}  // namespace burnish
