// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string_view>
#include <variant>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/testing/directions.h>

namespace burnish {

/// Draws parameters in the ranges of kOpenPbrInputs, each lobe absent, whole or in between. Floats hold the numbers.
inline OpenPbrParameters draw_openpbr(Pcg32& random) {
  OpenPbrParameters p;
  const auto within = [&](double min, double max) {
    return static_cast<double>(static_cast<float>(min + (max - min) * random.uniform()));
  };
  for (const OpenPbrInput& input : kOpenPbrInputs) {
    const bool share = input.name.ends_with("weight") || input.name == "base_metalness";
    if (const auto* number = std::get_if<double OpenPbrParameters::*>(&input.member)) {
      const double dice = random.uniform();
      p.*(*number) = share && dice < 0.4 ? (dice < 0.2 ? 0 : 1) : within(input.min, input.max);
    } else {
      p.*std::get<Rgb OpenPbrParameters::*>(input.member) = {within(0, 1), within(0, 1), within(0, 1)};
    }
  }
  return p;
}

/// Draws a light in any direction, or about the mirror direction of the viewer by slopes as wide as the roughness.
inline DirectionPair draw_highlight_pair(Pcg32& random, double roughness) {
  for (;;) {
    const Vec3 wo = random_upper_direction(random);
    Vec3 wi = random_upper_direction(random);
    if (random.uniform() < 0.5) {
      const double slope =
          roughness * roughness * std::sqrt(random.uniform() / (1 - random.uniform() * 0.999));
      const double phi = kTwoPi * random.uniform();
      const Vec3 h = normalize({slope * std::cos(phi), slope * std::sin(phi), 1});
      wi = 2 * dot(wo, h) * h - wo;
    }
    if (wi.z > 0.02 && wo.z > 0.02) return {wi, wo};
  }
}

}  // namespace burnish
