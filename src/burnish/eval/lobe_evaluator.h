// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <burnish/eval/factored_eval.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Evaluates the lobes of a factored BRDF in float, each by itself or as a sum with weights that change from call to
/// call. As in FactoredEvaluator, positions that lobes share are computed once. It takes one or three channels. Never
/// allocates after construction. Copies share the tables, and threads may share a copy.
class LobeEvaluator {
 public:
  static constexpr std::size_t kMaxLobes = 64;
  static constexpr std::size_t kWeightStride = 4;  ///< floats of a lobe's weights, one a channel

  /// Throws Error for other channels, more than kMaxLobes lobes, or what FactoredEvaluator does not take.
  explicit LobeEvaluator(const FactoredBrdf& brdf);

  std::size_t channels() const noexcept;
  std::size_t lobes() const noexcept;
  /// Returns FactoredEvaluator's bound of the relative error, for the value of a lobe.
  double rounding_bound() const noexcept;

  /// f_r of each lobe with its scale, 1/sr, without the cosine, zero below the horizon: channel c of lobe j of pair i
  /// is f[(j * channels() + c) * directions.size() + i].
  void eval(const DirectionSpans& directions, std::span<float> f) const noexcept;

  /// Finds the sum over lobes of weights[kWeightStride * j + c] times the lobe's value in channel c, for one pair of
  /// unit vectors. The fourth weight of a lobe is read but not used.
  void eval(Vec3 wi, Vec3 wo, std::span<const float> weights, std::span<float> f) const noexcept;

 private:
  std::shared_ptr<const FactoredPlan> plan_;
};

}  // namespace burnish
