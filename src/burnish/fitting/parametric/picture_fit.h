#pragma once

#include <functional>
#include <span>
#include <vector>

#include <burnish/fitting/numerics/bounded_least_squares.h>
#include <burnish/fitting/parametric/picture_pairs.h>
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
  /// How many numbers from one on are moved at once for their slopes: 1, or the 3 channels of a colour where each sees
  /// its own alone.
  std::function<std::size_t(std::size_t number)> together;
  /// The materials at several points, side by side.
  std::function<MaterialsEval(std::vector<std::vector<double>> points)> at;
};

/// How long a minimization goes on, and how strongly numbers are drawn to their normal values: one that is a whole
/// range off counts as an error of -20 log10(pull) dB.
struct FitEffort {
  int max_iterations;
  double tolerance, pull;
};

/// The material whose lit spheres differ least from those of `pairs` near a start, in the mean of the squares; pictures
/// at 1/32 of the exposure, so that highlights keep their height, and relative errors, which tell where pictures are
/// dark or saturated, add a little. Throws as solve_least_squares.
LeastSquaresSolution fit_pictures(const PicturePairs& pairs, const FittedMaterial& material,
                                  std::vector<double> start, const FitEffort& effort);

/// What a colour is guessed at: a diffuse albedo that shows the mean of the pictures, in [.02, .98].
Rgb mean_color(const PicturePairs& pairs);

/// Every n-th of the pixels.
PicturePairs thinned(const PicturePairs& pairs, std::size_t n);

}  // namespace burnish
