// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <burnish/fitting/fit_summary.h>
#include <burnish/fitting/numerics/bounded_least_squares.h>
#include <burnish/fitting/parametric/picture_pairs.h>
#include <burnish/math/parallel.h>
#include <burnish/math/rgb.h>

namespace burnish {

/// A number that a material's fit varies: its range, and the value that says nothing.
struct FittedNumber {
  double min, max, normal;
};

/// Sets three values, 1/sr, of each of several materials, one after the other.
using MaterialsEval = std::function<void(Vec3 wi, Vec3 wo, std::span<double> f)>;

/// A material as a function of numbers.
struct FittedMaterial {
  std::vector<FittedNumber> numbers;
  /// Returns how many numbers, from one on, are moved at once for their slopes: 1, or the 3 channels of a colour
  /// where each depends on its own alone.
  std::function<std::size_t(std::size_t number)> together;
  /// The materials at several points, side by side.
  std::function<MaterialsEval(std::vector<std::vector<double>> points)> at;
};

/// The length of a minimization, and the pull of numbers to their normal values: one that is a whole range off counts
/// as an error of -20 log10(pull) dB.
struct FitEffort {
  int max_iterations;
  double tolerance, pull;
};

/// The material whose lit spheres differ least from those of `pairs` near a start, in the mean of the squares; pictures
/// at 1/32 of the exposure, so that highlights keep their height, and relative errors, which tell where pictures are
/// dark or saturated, add a little. Throws as solve_least_squares.
LeastSquaresSolution fit_pictures(const PicturePairs& pairs, const FittedMaterial& material,
                                  std::vector<double> start, const FitEffort& effort);

/// The start of a minimization, and the inputs of the material that keep their values.
template <class Material, class Inputs>
struct FitStart {
  Material material;
  Inputs held;
};

/// The end of a minimization.
template <class Material, class Inputs>
struct FitTrial {
  Material material;
  Inputs held;
  double first_cost = 0, cost = 0;
  int iterations = 0;
  bool converged = false;
};

/// Runs minimizations side by side, and counts them.
template <class Material, class Inputs>
class FitSearch {
 public:
  using Start = FitStart<Material, Inputs>;
  using Trial = FitTrial<Material, Inputs>;
  using Minimize = std::function<Trial(const Start& start, const FitEffort& effort)>;

  explicit FitSearch(Minimize minimize) : minimize_(std::move(minimize)) {}

  /// The trials of these starts, best first.
  std::vector<Trial> run(const std::vector<Start>& starts, const FitEffort& effort) {
    std::vector<Trial> trials(starts.size());
    for_each_chunk(starts.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      trials[i] = minimize_(starts[i], effort);
    });
    for (const Trial& trial : trials) iterations += trial.iterations;
    count += static_cast<int>(trials.size());
    std::ranges::stable_sort(trials, {}, &Trial::cost);
    return trials;
  }

  /// Counts another's as its own.
  void add(const FitSearch& other) {
    iterations += other.iterations;
    count += other.count;
  }

  int iterations = 0, count = 0;

 private:
  Minimize minimize_;
};

/// Returns the ends of the first `count` trials as starts for others.
template <class Material, class Inputs>
std::vector<FitStart<Material, Inputs>> best_of(const std::vector<FitTrial<Material, Inputs>>& trials,
                                                std::size_t count) {
  std::vector<FitStart<Material, Inputs>> starts;
  for (std::size_t i = 0; i < std::min(count, trials.size()); ++i)
    starts.push_back({trials[i].material, trials[i].held});
  return starts;
}

template <class Material, class Inputs>
void add_starts(std::vector<FitStart<Material, Inputs>>& starts,
                const std::vector<FitStart<Material, Inputs>>& further) {
  starts.insert(starts.end(), further.begin(), further.end());
}

/// Returns the summary of a trial whose material is `shown`: the beginning's cost as an error, and the pictures'.
FitSummary summary_of(const PicturePairs& pairs, BrdfRef shown, double first_cost, int iterations,
                      bool converged);

/// A colour's channel, of 0 to 2.
constexpr double& channel_of(Rgb& color, int channel) noexcept {
  return channel == 0 ? color.r : channel == 1 ? color.g : color.b;
}

/// To six decimals, as fits write their numbers.
inline double round6(double x) {
  return std::round(x * 1e6) / 1e6;
}

/// Returns the first guess of a colour: a diffuse albedo that shows the mean of the pictures, in [.02, .98].
Rgb mean_color(const PicturePairs& pairs);

/// Every n-th of the pixels.
PicturePairs thinned(const PicturePairs& pairs, std::size_t n);

}  // namespace burnish
