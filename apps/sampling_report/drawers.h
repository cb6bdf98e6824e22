#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <burnish/eval/tabulated_sampler.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/reflectance/rgl_table.h>

namespace burnish {

// A measurement followed from the eye: with its directions exchanged, as RglSampler draws.
struct Measurement {
  const RglTable* table;

  int channels() const noexcept { return table->channels(); }
  bool isotropic() const noexcept { return table->isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept { return table->eval(wo, wi, f); }
};

inline constexpr std::size_t kWays = 5;
inline constexpr std::array<const char*, kWays> kWayNames{"cosine", "GGX", "GGX + cosine", "RGL's own",
                                                          "burnish"};
// and what drawing by the material alone aims at: the density f cos(theta_i) / albedo
inline constexpr std::size_t kDensities = kWays + 1, kOurs = kWays - 1;
inline constexpr const char* kProportional = "in proportion";

// The density of an isotropic BRDF's own light; nothing draws by it.
class Proportional {
 public:
  explicit Proportional(BrdfRef brdf) : brdf_(brdf) {
    std::vector<double> f(static_cast<std::size_t>(brdf.channels()));
    for (int i = 0; i <= kSteps; ++i) {
      const Vec3 wo = spherical_direction(std::min(radians(90.0 * i / kSteps), radians(89.9)), 0);
      double sum = 0;
      for (const auto& [wi, weight] : half_vector_quadrature(wo, 96, 96))
        sum += reflected_size(brdf, wi, wo, f) * weight;
      albedo_.push_back(sum);
    }
  }
  DrawnDirection sample_wi(Vec3, Point2) const noexcept { return {}; }
  double pdf(Vec3 wi, Vec3 wo) const noexcept {
    if (wi.z <= 0 || wo.z <= 0) return 0;
    std::array<double, 3> f;
    const double at = theta_of(wo) / kHalfPi * kSteps;
    const auto low = std::min(static_cast<std::size_t>(at), albedo_.size() - 2);
    const double part = at - static_cast<double>(low);
    return reflected_size(brdf_, wi, wo, f) / ((1 - part) * albedo_[low] + part * albedo_[low + 1]);
  }

 private:
  static constexpr int kSteps = 90;
  BrdfRef brdf_;
  std::vector<double> albedo_;
};

// A BRDF and every way to draw for it.
struct Drawers {
  CosineSampler cosine;
  GgxProxy ggx, ggx_and_cosine;
  RglSampler rgl;
  TabulatedSampler tabulated;

  Drawers(BrdfRef brdf, const RglTable& table)
      : ggx(fit_ggx_proxy(brdf, false)),
        ggx_and_cosine(fit_ggx_proxy(brdf, true)),
        rgl{&table},
        tabulated(brdf) {}
  std::array<SamplerRef, kWays> all() const { return {cosine, ggx, ggx_and_cosine, rgl, tabulated}; }
};

}  // namespace burnish
