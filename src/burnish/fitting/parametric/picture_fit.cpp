// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/fitting/parametric/picture_fit.h>
#include <burnish/fitting/refinement/picture_loss.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// Weight of the pictures at 1/32 of the exposure.
constexpr double kDimmedShare = 0.05;

// Relative errors, of ln(f + floor): at most a tenth of the whole where pictures differ visibly, but what tells where
// they are dark or saturated.
constexpr double kRelativeShare = 1e-3;

// A pixel in thirty of a highlight: what shows less, as an index that a coat hides, is not trusted to go far.
constexpr double kMinDiagonal = 1e-3;

// Numbers are moved by this part of their range for slopes.
constexpr double kStep = 1e-5;

constexpr std::size_t kPairsAtOnce = 128;

/// A channel of a pixel has an error at each exposure and a relative one, all functions of f: the error along their
/// slopes, what is left across them, and the slope.
struct Pixel {
  double along, across, slope;
};

/// The pictures' differences, and the numbers' from their normal values, as functions of the numbers.
class Cost {
 public:
  Cost(const PicturePairs& pairs, const FittedMaterial& material, double pull)
      : pairs_(pairs), material_(material), pull_(pull) {}

  /// One a channel of a pixel, one for what is left of them, one a number.
  std::size_t functions() const { return pairs_.shown.size() + 1 + material_.numbers.size(); }

  /// Evaluates as LeastSquaresProblem::evaluate says.
  void evaluate(std::span<const double> x, std::span<double> values, std::span<double> slopes) {
    const std::vector<Step> steps = slopes.empty() ? std::vector<Step>() : steps_from(x);
    const MaterialsEval eval = material_.at(points(x, steps));
    const std::size_t pixels = pairs_.shown.size(), columns = x.size();
    std::ranges::fill(slopes, 0.0);
    across_.resize(pixels);
    for_each_chunk(pairs_.pairs.size(), kPairsAtOnce, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::vector<double> f(3 * (1 + steps.size()));
      for (std::size_t i = begin; i < end; ++i) {
        eval(pairs_.pairs[i].wi, pairs_.pairs[i].wo, f);
        for (std::size_t c = 0; c < 3; ++c) {
          const Pixel pixel = pixel_of(3 * i + c, f[c]);
          values[3 * i + c] = pixel.along;
          across_[3 * i + c] = pixel.across;
          for (std::size_t s = 0; s < steps.size(); ++s) {
            const std::size_t channel = steps[s].count == 3 ? c : 0;
            slopes[(3 * i + c) * columns + steps[s].first + channel] =
                pixel.slope * (f[3 * (s + 1) + c] - f[c]) / steps[s].size[channel];
          }
        }
      }
    });
    double rest = 0;
    for (const double across : across_) rest += across * across;
    values[pixels] = std::sqrt(rest);
    for (std::size_t k = 0; k < columns; ++k) {
      const FittedNumber& number = material_.numbers[k];
      values[pixels + 1 + k] = pull_ * (x[k] - number.normal) / (number.max - number.min);
      if (!slopes.empty()) slopes[(pixels + 1 + k) * columns + k] = pull_ / (number.max - number.min);
    }
  }

 private:
  /// A difference that slopes are found by: of one number, or of the channels of a colour that do not see each other.
  struct Step {
    std::size_t first, count;
    std::array<double, 3> size;
  };

  /// Forwards, but backwards at an upper bound.
  std::vector<Step> steps_from(std::span<const double> x) const {
    std::vector<Step> steps;
    for (std::size_t k = 0; k < x.size(); k += steps.back().count) {
      Step step{k, material_.together(k), {}};
      for (std::size_t c = 0; c < step.count; ++c) {
        const FittedNumber& number = material_.numbers[k + c];
        const double size = kStep * (number.max - number.min);
        step.size[c] = x[k + c] + size > number.max ? -size : size;
      }
      steps.push_back(step);
    }
    return steps;
  }

  std::vector<std::vector<double>> points(std::span<const double> x, std::span<const Step> steps) const {
    std::vector<std::vector<double>> all(1 + steps.size(), std::vector<double>(x.begin(), x.end()));
    for (std::size_t s = 0; s < steps.size(); ++s)
      for (std::size_t c = 0; c < steps[s].count; ++c) all[s + 1][steps[s].first + c] += steps[s].size[c];
    return all;
  }

  Pixel pixel_of(std::size_t r, double f) const {
    constexpr double kDark = 1e-9;  // bounds slopes where f is next to nothing
    const double area = std::sqrt(pairs_.weights[r / 3] / 3);
    const double shown =
        std::pow(std::max(pairs_.exposure * f * pairs_.pairs[r / 3].wi.z, 0.0), PictureLoss::kInverseGamma);
    const double shown_slope = PictureLoss::kInverseGamma * shown / std::max(f, kDark);
    std::array<double, 3> error, slope;
    for (std::size_t e = 0; e < 2; ++e) {
      const double ours = kDims[e] * shown, theirs = kDims[e] * pairs_.shown[r];
      error[e] = area * kShares[e] * (std::min(1.0, ours) - std::min(1.0, theirs));
      // a pixel too bright that should not be is told so
      const double seen = ours <= 1 ? 1 : theirs < 1 ? PictureLoss::kSaturatedSlope : 0;
      slope[e] = area * kShares[e] * kDims[e] * seen * shown_slope;
    }
    const double log_weight = area * std::sqrt(kRelativeShare), above = f + PictureLoss::kFloor;
    error[2] = log_weight * std::log(above / (pairs_.values[r] + PictureLoss::kFloor));
    slope[2] = log_weight / above;
    double squares = 0, products = 0, slopes = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      squares += error[e] * error[e];
      products += error[e] * slope[e];
      slopes += slope[e] * slope[e];
    }
    const double length = std::sqrt(slopes), along = products / length;
    return {along, std::sqrt(std::max(squares - along * along, 0.0)), length};
  }

  /// For both exposures, the root of the error's weight, and the factor of a pixel.
  static inline const std::array<double, 2> kShares = {1, std::sqrt(kDimmedShare)},
                                            kDims = {1, std::pow(1.0 / 32, PictureLoss::kInverseGamma)};

  const PicturePairs& pairs_;
  const FittedMaterial& material_;
  const double pull_;
  std::vector<double> across_;
};

}  // namespace

LeastSquaresSolution fit_pictures(const PicturePairs& pairs, const FittedMaterial& material,
                                  std::vector<double> start, const FitEffort& effort) {
  Cost cost(pairs, material, effort.pull);
  LeastSquaresProblem problem{.functions = cost.functions(), .evaluate = {}, .lower = {}, .upper = {}};
  for (const FittedNumber& number : material.numbers) {
    problem.lower.push_back(number.min);
    problem.upper.push_back(number.max);
  }
  problem.evaluate = [&](auto at, auto values, auto slopes) { cost.evaluate(at, values, slopes); };
  return solve_least_squares(problem, std::move(start),
                             {.max_iterations = effort.max_iterations,
                              .tolerance = effort.tolerance,
                              .least_diagonal = kMinDiagonal});
}

FitSummary summary_of(const PicturePairs& pairs, BrdfRef shown, double first_cost, int iterations,
                      bool converged) {
  return {.error_before = std::sqrt(2 * first_cost),
          .error_after = std::sqrt(pairs.mean_squared_error(pairs.shown_of(shown))),
          .iterations = iterations,
          .stop_reason = converged ? StopReason::converged : StopReason::iteration_limit};
}

Rgb mean_color(const PicturePairs& pairs) {
  std::array<double, 3> sum{};
  double total = 0;
  for (std::size_t i = 0; i < pairs.pairs.size(); ++i) {
    total += pairs.weights[i] * pairs.pairs[i].wi.z;
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] +=
          pairs.weights[i] * std::pow(std::min(1.0, pairs.shown[3 * i + c]), 1 / PictureLoss::kInverseGamma);
  }
  const auto of = [&](double s) { return std::clamp(kPi * s / (pairs.exposure * total), 0.02, 0.98); };
  return {of(sum[0]), of(sum[1]), of(sum[2])};
}

PicturePairs thinned(const PicturePairs& pairs, std::size_t n) {
  PicturePairs thin;
  thin.exposure = pairs.exposure;
  for (std::size_t i = 0; i < pairs.pairs.size(); i += n) {
    thin.pairs.push_back(pairs.pairs[i]);
    thin.weights.push_back(static_cast<double>(n) * pairs.weights[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      thin.values.push_back(pairs.values[3 * i + c]);
      thin.shown.push_back(pairs.shown[3 * i + c]);
    }
  }
  return thin;
}

}  // namespace burnish
