// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/error.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

SeparableBrdf::SeparableBrdf(NodeTable u, NodeTable v, std::vector<float> scale)
    : u_(std::move(u)), v_(std::move(v)), scale_(std::move(scale)) {
  constexpr float kMaxScale = 1e9f;
  if (scale_.empty() || scale_.size() > SymmetrizedBrdf::kMaxChannels)
    throw Error(fmt::format("separable BRDF: expected 1 to {} scales, one a channel, found {}",
                            SymmetrizedBrdf::kMaxChannels, scale_.size()));
  for (const float s : scale_)
    if (!(s >= 0 && s <= kMaxScale))
      throw Error(fmt::format("separable BRDF: expected a scale in [0, {}], found {}", kMaxScale, s));
  check_node_table(u_, channels(), "u");
  check_node_table(v_, channels(), "v");
  if (u_.terms != v_.terms || u_.terms > kMaxTerms)
    throw Error(fmt::format("separable BRDF: expected as many terms in u and v, at most {}, found {} and {}",
                            kMaxTerms, u_.terms, v_.terms));

  // every coordinate belongs to one of the two
  unsigned used = 0;
  for (const NodeTable* table : {&u_, &v_})
    for (const NodeAxis& axis : table->axes) {
      const unsigned bit = 1u << static_cast<unsigned>(axis.coordinate);
      if (used & bit)
        throw Error(
            fmt::format("separable BRDF: expected {} once, found it again", to_string(axis.coordinate)));
      used |= bit;
      isotropic_ = isotropic_ && is_isotropic(axis.coordinate);
    }
}

double separable_divisor(Vec3 wi, Vec3 wo) noexcept {
  return std::sqrt(std::max(wi.z * wo.z, kDrawnCosine * kDrawnCosine));
}

void SeparableBrdf::eval_signed(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::fill(f.begin(), f.end(), 0.0);
  if (wi.z <= 0 || wo.z <= 0) return;
  const PairPlace place(wi, wo);
  const NodeCorners in_u = corners(u_.axes, place), in_v = corners(v_.axes, place);
  const double divisor = separable_divisor(wi, wo);
  for (std::size_t c = 0; c < f.size(); ++c) {
    const std::size_t cu = u_.channels == 1 ? 0 : c, cv = v_.channels == 1 ? 0 : c;
    double sum = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(u_.terms); ++k)
      sum += node_value(u_, in_u, cu, k) * node_value(v_, in_v, cv, k);  // [Kautz 1999, eq. 3]
    f[c] = scale_[c] * sum / divisor;
  }
}

bool SeparableBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  eval_signed(wi, wo, f);
  for (double& value : f) value = std::max(value, 0.0);
  return true;
}

std::size_t SeparableBrdf::bytes() const noexcept {
  return 2 * (u_.values.size() + v_.values.size()) + sizeof(float) * scale_.size();
}

}  // namespace burnish
