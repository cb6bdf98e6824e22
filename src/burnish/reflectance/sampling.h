// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>

#include <burnish/math/angles.h>
#include <burnish/math/point2.h>
#include <burnish/math/vec3.h>

namespace burnish {

/// A direction to the light that was drawn at random, and its density per solid angle, 1/sr. Zero density:
/// rounding put the direction onto the horizon, and the draw counts as one that carries no light.
struct DrawnDirection {
  Vec3 wi;
  double pdf = 0;
};

/// The concept of a sampler, which draws directions for a given wo, wo.z > 0:
/// - sample_wi(wo, u): the direction that the uniform point u of the unit square becomes, with its density;
/// - pdf(wi, wo): that density, 1/sr, for any unit vector wi; zero for wi.z <= 0. It integrates to at most 1
///   over the upper hemisphere: the rest is drawn below the horizon.
/// Never allocates, never throws.
// clang-format off
template <class T>
concept DirectionSampler = requires(const T& sampler, Vec3 w, Point2 u) {
  { sampler.sample_wi(w, u) } noexcept -> std::same_as<DrawnDirection>;
  { sampler.pdf(w, w) } noexcept -> std::same_as<double>;
};
// clang-format on

/// A non-owning reference to any DirectionSampler.
class SamplerRef {
 public:
  // clang-format off
  template <DirectionSampler T>
    requires(!std::same_as<T, SamplerRef>)
  SamplerRef(const T& sampler) noexcept  // NOLINT: implicit like std::span
      : sampler_(&sampler),
        sample_([](const void* s, Vec3 wo, Point2 u) noexcept {
          return static_cast<const T*>(s)->sample_wi(wo, u);
        }),
        pdf_([](const void* s, Vec3 wi, Vec3 wo) noexcept {
          return static_cast<const T*>(s)->pdf(wi, wo);
        }) {}
  // clang-format on

  DrawnDirection sample_wi(Vec3 wo, Point2 u) const noexcept { return sample_(sampler_, wo, u); }
  double pdf(Vec3 wi, Vec3 wo) const noexcept { return pdf_(sampler_, wi, wo); }

 private:
  const void* sampler_;
  DrawnDirection (*sample_)(const void*, Vec3, Point2) noexcept;
  double (*pdf_)(const void*, Vec3, Vec3) noexcept;
};

/// In proportion to the cosine, whatever the material.
struct CosineSampler {
  DrawnDirection sample_wi(Vec3, Point2 u) const noexcept {
    const double r = std::sqrt(u.x), phi = kTwoPi * u.y, cosine = std::sqrt(std::max(0.0, 1 - u.x));
    return {{r * std::cos(phi), r * std::sin(phi), cosine}, cosine / kPi};
  }
  double pdf(Vec3 wi, Vec3) const noexcept { return std::max(wi.z, 0.0) / kPi; }
};

static_assert(DirectionSampler<CosineSampler> && DirectionSampler<SamplerRef>);

}  // namespace burnish
