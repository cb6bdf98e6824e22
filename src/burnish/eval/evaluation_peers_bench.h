// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/eval/factored_eval.h>
#include <burnish/reflectance/analytic/microfacet.h>
#include <burnish/reflectance/half_diff_table.h>

namespace burnish {

// Other representations, evaluated as fast as their users would: in float, with the widest vectors, and with the
// spans and planes of FactoredEvaluator. All have three channels and take a multiple of 16 directions above the
// horizon.

/// A microfacet model of tables over angles in steps of pi/2 / (kAngles - 1), interpolated linearly: diffuse +
/// D(theta_h) F(theta_d) G(theta_i) G(theta_o) / (4 cos_i cos_o) [Bagher 2016].
struct TabulatedMicrofacets {
  static constexpr int kAngles = 90;
  std::array<float, 3> diffuse{};
  std::array<std::vector<float>, 3> d, f, g;  // a channel, kAngles each

  static constexpr std::size_t channels() noexcept { return 3; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};
static_assert(Brdf<TabulatedMicrofacets>);

void eval_tabulated(const TabulatedMicrofacets& brdf, const DirectionSpans& directions, std::span<float> f);

/// Evaluates the network of NeuralBrdf with these weights.
void eval_neural(std::span<const float> weights, const DirectionSpans& directions, std::span<float> f);

/// Evaluates an isotropic GGX model.
void eval_ggx(const Ggx& brdf, const DirectionSpans& directions, std::span<float> f);

/// Measures the limit of table reads: loads pairs of neighbouring nodes and adds them up. Each load is eight floats
/// from a place in the table; the number of places is a multiple of eight.
float load_nodes(std::span<const float> table, std::span<const std::int32_t> node);

/// Measures the limit of arithmetic with fused multiply-adds in 16 independent chains. Returns their number.
std::size_t multiply_add(std::size_t steps, float factor, std::span<float, 64> last);

/// Evaluates as NearestHalfDiff does, with phi_d over half a circle.
void eval_nearest(const HalfDiffTable& table, const DirectionSpans& directions, std::span<float> f);

}  // namespace burnish
