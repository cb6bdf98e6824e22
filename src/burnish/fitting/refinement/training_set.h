// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sample_source.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// The light that is reflected from some directions: sums over pairs of a direction wi and points wo.
struct AlbedoSet {
  std::size_t directions = 0;
  std::vector<DirectionPair> pairs;  ///< [direction][point], as many points for each
  std::vector<float> weights;        ///< cos(theta_o) times solid angle, one a pair; 0 where f is unknown
  std::vector<float> targets;        ///< [direction][channel], >= 0
  std::vector<float> scales;         ///< errors of the targets are divided by these, > 0

  bool empty() const noexcept { return directions == 0; }
  std::size_t points() const noexcept { return pairs.size() / directions; }
};

/// The data that a model of several lobes is refined on: pixels of lit spheres, which the eye judges, and direction
/// pairs spread over all directions, which keep the model right where no picture looks.
struct TrainingSet {
  std::size_t channels = 0;
  bool isotropic = false;
  std::vector<DirectionPair> pairs;  ///< above the horizon
  std::vector<float> values;         ///< f_r >= 0 of pair i at [i * channels, (i + 1) * channels), 1/sr
  std::vector<float> weights;        ///< one a pair, > 0
  /// Factors of each lobe's value at each pair, >= 0, [pair][lobe]. Pairs of different places on a surface differ in
  /// these. Empty: 1. Refinement uses them; log-linear fits do not.
  std::vector<float> lobe_weights;
  std::size_t picture_count = 0;  ///< the first picture_count pairs are pixels
  double exposure = 1;            ///< 1 / (97th percentile of the pixels' f_r cos theta_i)
  AlbedoSet albedo;               ///< empty: albedos do not count

  std::size_t size() const noexcept { return pairs.size(); }
};

struct TrainingOptions {
  std::size_t pictures = 20'000;    ///< pixels
  std::size_t directions = 60'000;  ///< pairs spread over all directions
  /// Half of the pixels have theta_h = pi/2 u^2. All are weighted as if they were uniform on the disk, and the
  /// exposure counts those in the dark too.
  bool crowded = false;
  std::uint64_t seed = 1;
  bool spread_phi_h = false;  ///< turn pairs of isotropic sources about the normal, which 2-D tables need
};

/// Draws low-discrepancy points, the same for the same seed:
/// - pixels uniform on the visible disk of a sphere seen from afar, under a light whose angle to the view is
///   uniform in [0, 75] degrees, as long as both cosines are above 0.01; crowded ones as the option says, as
///   long as both are above 0.001;
/// - pairs with theta_d, phi_d and phi_h uniform and theta_h half uniform, half pi/2 u^2, weighted as if it were
///   uniform, as long as both cosines are above 0.05. Beside those asked for, pairs that come up with both above
///   0.005 are kept with a tenth of the weight, so that the model stays bounded there.
/// Pairs that the source does not know are left out. Throws Error if nothing is left. No albedos.
TrainingSet draw_training_set(BrdfRef source, const TrainingOptions& options);

/// Returns the albedos of a source's raw values (see BrdfRef::unclamped) under light from 0 to 70 degrees, for
/// anisotropic sources from four sides. Points stand on rings about the mirror direction, as directional_albedo takes
/// them.
/// Targets are at least 0. Errors are relative to at least the mean over the channels, since the albedo of a colour
/// outside the gamut may be below zero in one channel.
AlbedoSet albedo_set(BrdfRef source);

/// Makes a set of scattered measurements above the horizon, with weight 1, no pictures and no albedos. With
/// `symmetrize` each measurement also stands for its swapped pair. Throws Error if nothing is left.
TrainingSet training_set_of(const Samples& samples, bool symmetrize);

/// Returns the pairs of the set in an order, pixels before others.
TrainingSet taken(const TrainingSet& set, std::span<const std::size_t> order);

/// Returns every `step`-th pixel and every `step`-th pair; step >= 1.
TrainingSet thinned(const TrainingSet& set, std::size_t step);

/// Returns the set as samples of a log-linear fit, with `values` in place of its own. Both must outlive the result.
SampleSource as_source(const TrainingSet& set, const std::vector<float>& values);

}  // namespace burnish
