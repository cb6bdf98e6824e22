// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Measurements to be fitted, produced on demand in any order so that a large table need not be copied.
struct SampleSource {
  std::size_t count = 0;
  std::size_t distinct = 0;  ///< sample i + distinct is sample i with wi and wo exchanged
  std::size_t channels = 0;
  bool isotropic = false;
  /// Writes samples [begin, begin + pairs.size()): directions, values (channel fastest, 1/sr) and the
  /// relative weight of each sample, 0 where there is none. Called from several threads.
  std::function<void(std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                     std::span<double> weights)>
      fill;
};

/// The scattered samples as they are, weight 1. `samples` must outlive the source. With `symmetrize` each
/// sample also stands for its swapped pair (count doubles), which is how scattered data become reciprocal
/// without resampling.
SampleSource from_samples(const Samples& samples, bool symmetrize);

/// Returns the weight of a pair drawn with theta_h = pi/2 u^2: sin(theta_h) min(cos theta_i, cos theta_o). The first
/// factor leads from the sampling, dense where highlights are narrow, towards the solid angle that h takes up in a
/// picture. The second fades out grazing directions, which pictures hardly show and instruments measure badly.
double pair_weight(Vec3 wi, Vec3 wo) noexcept;

/// `count` pairs of a low-discrepancy sequence: theta_d, phi_d and phi_h uniform, theta_h = pi/2 u^2
/// (measured tables space theta_h that way), with pair_weight. Isotropic sources are measured at phi_h = 0
/// unless `spread_phi_h`, which 2-D tables need to be filled. The Brdf behind `source` must outlive the
/// result.
SampleSource from_brdf(BrdfRef source, std::size_t count, std::uint64_t seed, bool spread_phi_h);

/// Every entry of the table that is no hole, with pair_weight, at its cell's centre and phi_h = 0, or phi_h
/// spread over the circle. With `symmetrize` an entry of a full-circle table is the mean with the one half a
/// turn of phi_d away. `table` must outlive the source.
SampleSource from_table(const HalfDiffTable& table, bool symmetrize, bool spread_phi_h);

}  // namespace burnish
