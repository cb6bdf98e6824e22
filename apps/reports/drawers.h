// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <burnish/eval/factored_eval.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/reflectance/rgl_table.h>

namespace burnish::reports {

// A measurement whose paths start at the eye: its directions are exchanged, as RglSampler draws them.
struct Measurement {
  const RglTable* table;

  std::size_t channels() const noexcept { return table->channels(); }
  bool isotropic() const noexcept { return table->isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept { return table->eval(wo, wi, f); }
};

inline constexpr std::size_t kWays = 5;
inline constexpr std::array<const char*, kWays> kWayNames{"cosine", "GGX", "GGX + cosine", "RGL's own",
                                                          "burnish"};
// The last density is the aim of drawing by the material alone: f cos(theta_i) / albedo.
inline constexpr std::size_t kDensities = kWays + 1, kOurs = kWays - 1;
inline constexpr const char* kProportional = "in proportion";

// The albedo of an isotropic BRDF by the angle of wo, as the root mean square of the channels.
class Albedo {
 public:
  explicit Albedo(BrdfRef brdf) {
    std::vector<double> f(brdf.channels());
    for (int i = 0; i <= kSteps; ++i) {
      const Vec3 wo = spherical_direction(std::min(radians(90.0 * i / kSteps), radians(89.9)), 0);
      double sum = 0;
      for (const auto& [wi, weight] : half_vector_quadrature(wo, 96, 96))
        sum += reflected_size(brdf, wi, wo, f) * weight;
      albedo_.push_back(sum);
    }
  }
  double operator()(Vec3 wo) const noexcept {
    const double at = theta_of(wo) / kHalfPi * kSteps;
    const auto low = std::min(static_cast<std::size_t>(at), albedo_.size() - 2);
    const double part = at - static_cast<double>(low);
    return (1 - part) * albedo_[low] + part * albedo_[low + 1];
  }

 private:
  static constexpr int kSteps = 90;
  std::vector<double> albedo_;
};

// The density in proportion to an isotropic BRDF's f cos(theta_i). It cannot draw directions.
class Proportional {
 public:
  explicit Proportional(BrdfRef brdf) : brdf_(brdf), albedo_(brdf) {}
  DrawnDirection sample_wi(Vec3, Point2) const noexcept { return {}; }
  double pdf(Vec3 wi, Vec3 wo) const noexcept {
    if (wi.z <= 0 || wo.z <= 0) return 0;
    std::array<double, 3> f;
    return reflected_size(brdf_, wi, wo, f) / albedo_(wo);
  }

 private:
  BrdfRef brdf_;
  Albedo albedo_;
};

// Chooses a lobe by its albedo for this wo, and draws from that lobe's own tables. The density sums over all lobes.
class LobeChoice {
 public:
  explicit LobeChoice(const FactoredBrdf& model) {
    for (const Lobe& lobe : model.lobes()) {
      const FactoredBrdf alone(model.channels(), {model.tables().begin(), model.tables().end()}, {lobe});
      const FactoredEvaluator evaluator(alone);
      lobes_.push_back({Albedo(evaluator), TabulatedSampler(evaluator)});
    }
  }
  std::size_t lobes() const noexcept { return lobes_.size(); }

  DrawnDirection sample_wi(Vec3 wo, Point2 u) const noexcept {
    double left = u.x * total(wo);
    std::size_t chosen = 0;
    for (; chosen + 1 < lobes_.size() && left >= lobes_[chosen].albedo(wo); ++chosen)
      left -= lobes_[chosen].albedo(wo);
    u.x = std::clamp(left / lobes_[chosen].albedo(wo), 0.0, 1 - 1e-12);
    DrawnDirection drawn = lobes_[chosen].sampler.sample_wi(wo, u);
    if (drawn.pdf > 0) drawn.pdf = pdf(drawn.wi, wo);
    return drawn;
  }
  double pdf(Vec3 wi, Vec3 wo) const noexcept {
    double sum = 0;
    for (const auto& [albedo, sampler] : lobes_) sum += albedo(wo) * sampler.pdf(wi, wo);
    return sum / total(wo);
  }

 private:
  struct OneLobe {
    Albedo albedo;
    TabulatedSampler sampler;
  };
  double total(Vec3 wo) const noexcept {
    double sum = 0;
    for (const OneLobe& lobe : lobes_) sum += lobe.albedo(wo);
    return sum;
  }
  std::vector<OneLobe> lobes_;
};

// A BRDF with every way to draw directions for it.
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

}  // namespace burnish::reports
