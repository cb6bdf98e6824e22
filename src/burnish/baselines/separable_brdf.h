// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/baselines/node_table.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A BRDF read off a matrix of low rank, f = max(0, scale Σ_k u_k v_k) / sqrt(max(cos θ_i cos θ_o, c²)) with
/// c = kDrawnCosine of reflectance/goniometer.h: what singular value, normalized and nonnegative
/// decompositions of a resampled BRDF give. u and v are tables over disjoint coordinates, their terms of any
/// sign. The root of the cosines bounds the rise of f towards grazing directions, which would otherwise be
/// most of what a decomposition sees. Reciprocal to the last bit. Source: [Kautz 1999, eq. 3].
class SeparableBrdf {
 public:
  static constexpr int kMaxTerms = 1024;

  /// Throws Error unless the tables pass check_node_table and have as many terms as each other, at most
  /// kMaxTerms, no coordinate stands twice, and there is one scale in [0, 1e9] a channel.
  SeparableBrdf(NodeTable u, NodeTable v, std::vector<float> scale);

  std::size_t channels() const noexcept { return scale_.size(); }
  bool isotropic() const noexcept { return isotropic_; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// Evaluates as eval, with values below zero left as they are.
  void eval_signed(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  const NodeTable& u() const noexcept { return u_; }
  const NodeTable& v() const noexcept { return v_; }
  std::span<const float> scale() const noexcept { return scale_; }
  /// 2 bytes a table value, 4 a scale.
  std::size_t bytes() const noexcept;

  friend bool operator==(const SeparableBrdf&, const SeparableBrdf&) = default;

 private:
  NodeTable u_, v_;
  std::vector<float> scale_;
  bool isotropic_ = true;
};

static_assert(Brdf<SeparableBrdf>);

/// sqrt(max(cos θ_i cos θ_o, c²)), what SeparableBrdf divides by.
double separable_divisor(Vec3 wi, Vec3 wo) noexcept;

}  // namespace burnish
