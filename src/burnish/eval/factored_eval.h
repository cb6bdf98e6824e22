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

/// The same as rows of three floats (x, y, z), one after the other.
struct DirectionRows {
  std::span<const float> wi, wo;

  std::size_t size() const noexcept { return wi.size() / 3; }
};

/// Evaluates a factored BRDF in float, prepared once for many directions: what the factors share (half
/// vectors, projections, positions in tables) is found beforehand and computed once a direction, and tables
/// are copied with their channels padded to whole vectors. Satisfies Brdf. Never allocates after
/// construction; copies share the tables, threads may share a copy.
///
/// Reciprocal models stay reciprocal to the last bit, and both forms of eval give the same bits. Against
/// FactoredBrdf::eval of the same directions the relative error of values above 2^-126 is at most
/// rounding_bound(); where a model has projections other than wi, wo, h and d, times the largest
/// (sum of |coefficients|) / |combination|: terms that cancel leave their rounding errors.
class FactoredEvaluator {
 public:
  /// Throws Error for models of more than 1024 different positions in tables.
  explicit FactoredEvaluator(const FactoredBrdf& brdf);

  std::size_t channels() const noexcept;
  bool isotropic() const noexcept;

  /// f_r in 1/sr, without the cosine, zero below the horizon: f[c * directions.size() + i] is channel c of
  /// pair i; f has channels() * directions.size() entries. One plane a channel, as the directions have one a
  /// component: what follows (cosine, light, sum) runs over the same lanes.
  void eval(const DirectionSpans& directions, std::span<float> f) const noexcept;

  /// The same for a part of larger planes: channel c of pair i is f[c * plane + i], plane >=
  /// directions.size(), and f ends with the last value.
  void eval(const DirectionSpans& directions, std::span<float> f, std::size_t plane) const noexcept;

  /// Rows in, rows out: f[channels() * i + c] is channel c of pair i. The same bits.
  void eval(const DirectionRows& directions, std::span<float> f) const noexcept;

  /// One pair, without a block's preparations; f has channels() entries. The same bits as of many.
  void eval(Vec3 wi, Vec3 wo, std::span<float> f) const noexcept;
  /// The same as a Brdf, for renderers that take any: true, and f_r in doubles.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// The largest of the lobes' sums over their factors of 2^-24 (8 R + 16 axes (n - 1) (R - 1)): a position
  /// is off by at most 16 * 2^-24 of an axis of n nodes, and a table's neighbouring entries differ by at most
  /// the factor R. Steep tables make this pessimistic: it takes every lookup to be at its worst.
  double rounding_bound() const noexcept;

 private:
  std::shared_ptr<const FactoredPlan> plan_;
};

static_assert(Brdf<FactoredEvaluator>);

}  // namespace burnish
