#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <burnish/eval/factored_eval.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Evaluates the lobes of a factored BRDF in float, each apart or with weights that change from call to call, as
/// FactoredEvaluator evaluates their sum: positions that they share are found once. One or three channels. Never
/// allocates after construction; copies share the tables, threads may share a copy.
class LobeEvaluator {
 public:
  static constexpr std::size_t kMaxLobes = 64;
  static constexpr std::size_t kWeightStride = 4;  ///< floats of a lobe's weights, one a channel

  /// Throws Error for other channels, more than kMaxLobes lobes, or what FactoredEvaluator does not take.
  explicit LobeEvaluator(const FactoredBrdf& brdf);

  std::size_t channels() const noexcept;
  std::size_t lobes() const noexcept;
  /// Relative, of a lobe's value: FactoredEvaluator's.
  double rounding_bound() const noexcept;

  /// f_r of each lobe with its scale, 1/sr, without the cosine, zero below the horizon: channel c of lobe j of pair i
  /// is f[(j * channels() + c) * directions.size() + i].
  void eval(const DirectionSpans& directions, std::span<float> f) const noexcept;

  /// The sum over lobes of weights[kWeightStride * j + c] times the lobe's value in channel c, of one pair; unit
  /// vectors. The fourth of a lobe's weights is read and not used.
  void eval(Vec3 wi, Vec3 wo, std::span<const float> weights, std::span<float> f) const noexcept;

 private:
  std::shared_ptr<const FactoredPlan> plan_;
};

}  // namespace burnish
