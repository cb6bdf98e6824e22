// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

struct FactoredPlan;

/// Direction pairs, one array a component, all of one length. wi and wo are unit vectors to 2^-22. Vectors whose
/// squared length differs from 1 by more than 0.02 give not-a-number.
struct DirectionSpans {
  std::span<const float> wi_x, wi_y, wi_z, wo_x, wo_y, wo_z;

  std::size_t size() const noexcept { return wi_x.size(); }
};

/// Direction pairs as rows of three floats (x, y, z), one after the other.
struct DirectionRows {
  std::span<const float> wi, wo;

  std::size_t size() const noexcept { return wi.size() / 3; }
};

/// Evaluates a factored BRDF in float, prepared once for many directions. Values that factors share (half vectors,
/// projections, positions in tables) are identified beforehand and computed once a direction. Tables are copied with
/// their channels padded to whole vectors. Satisfies Brdf. Never allocates after construction. Copies share the
/// tables, and threads may share a copy.
///
/// Reciprocal models stay reciprocal to the last bit, and both forms of eval give the same bits. The error is
/// relative to FactoredBrdf::eval of the same directions: for values above 2^-126 it is at most rounding_bound(). If
/// a model has projections other than wi, wo, h and d, the bound is multiplied by the largest (sum of |coefficients|)
/// / |combination|, because terms that cancel leave their rounding errors.
class FactoredEvaluator {
 public:
  /// Throws Error for models of more than 1024 different positions in tables.
  explicit FactoredEvaluator(const FactoredBrdf& brdf);

  std::size_t channels() const noexcept;
  bool isotropic() const noexcept;

  /// f_r in 1/sr, without the cosine, zero below the horizon: f[c * directions.size() + i] is channel c of pair i. f
  /// has channels() * directions.size() entries. Each channel has one plane, as each component of the directions has,
  /// so that later steps (cosine, light, sum) run over the same lanes.
  void eval(const DirectionSpans& directions, std::span<float> f) const noexcept;

  /// Evaluates into a part of larger planes: channel c of pair i is f[c * plane + i], plane >= directions.size(). f
  /// ends with the last value.
  void eval(const DirectionSpans& directions, std::span<float> f, std::size_t plane) const noexcept;

  /// Evaluates rows into rows: f[channels() * i + c] is channel c of pair i. The bits are the same.
  void eval(const DirectionRows& directions, std::span<float> f) const noexcept;

  /// Evaluates one pair, without the preparations for a block; f has channels() entries. The bits are the same.
  void eval(Vec3 wi, Vec3 wo, std::span<float> f) const noexcept;
  /// Evaluates as a Brdf, for renderers that take any BRDF: returns true, and f_r in doubles.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// Returns the largest, over the lobes, of the sum over their factors of 2^-24 (8 R + 16 axes (n - 1) (R - 1)). A
  /// position is off by at most 16 * 2^-24 of an axis of n nodes, and neighbouring entries of a table differ by at
  /// most the factor R. The bound assumes that every lookup has the worst case, so it is pessimistic for steep
  /// tables.
  double rounding_bound() const noexcept;

 private:
  std::shared_ptr<const FactoredPlan> plan_;
};

static_assert(Brdf<FactoredEvaluator>);

}  // namespace burnish
