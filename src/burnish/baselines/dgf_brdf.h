// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/baselines/node_table.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A microfacet model whose distribution D, masking G and Fresnel factor F are tables:
///   f = diffuse + scale D(θ_h) F(θ_d) G(θ_i) G(θ_o) / max(cos θ_i cos θ_o, c²),  c = kDrawnCosine,
/// each constant and table one channel or all. Isotropic, >= 0, reciprocal to the last bit.
/// Source: [Bagher 2016].
class DgfBrdf {
 public:
  /// D has the axis theta_h, F and G have theta_d (G is looked up where a direction meets its mirror image,
  /// whose theta_d is its polar angle), one term each. Throws Error unless they pass check_node_table with
  /// values >= 0, and diffuse and scale have one entry in [0, 1e30] a channel.
  DgfBrdf(std::vector<float> diffuse, std::vector<float> scale, NodeTable d, NodeTable g, NodeTable f);

  std::size_t channels() const noexcept { return diffuse_.size(); }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  std::span<const float> diffuse() const noexcept { return diffuse_; }  ///< 1/sr, one a channel
  std::span<const float> scale() const noexcept { return scale_; }      ///< 1/sr, one a channel
  const NodeTable& d() const noexcept { return d_; }
  const NodeTable& g() const noexcept { return g_; }
  const NodeTable& f() const noexcept { return f_; }
  /// 2 bytes a table value, 4 a constant.
  std::size_t bytes() const noexcept;

  friend bool operator==(const DgfBrdf&, const DgfBrdf&) = default;

 private:
  std::vector<float> diffuse_, scale_;
  NodeTable d_, g_, f_;
};

static_assert(Brdf<DgfBrdf>);

/// Returns the place of G for a direction: its polar angle takes the part of theta_d.
inline PairPlace masking_place(Vec3 w) noexcept {
  return PairPlace(w, mirror(w));
}

/// max(cos θ_i cos θ_o, c²), what DgfBrdf divides by.
double microfacet_divisor(Vec3 wi, Vec3 wo) noexcept;

}  // namespace burnish
