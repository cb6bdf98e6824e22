// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Scattered measurements of one surface: pair i has the values [i * channels, (i + 1) * channels), f_r in
/// 1/sr, channel fastest.
struct Samples {
  std::size_t channels = 0;
  bool isotropic = false;
  std::vector<DirectionPair> pairs;
  std::vector<double> values;

  std::size_t size() const noexcept { return pairs.size(); }
  std::span<const double> at(std::size_t i) const noexcept {
    const auto c = channels;
    return std::span(values).subspan(i * c, c);
  }
  std::span<double> at(std::size_t i) noexcept {
    const auto c = channels;
    return std::span(values).subspan(i * c, c);
  }
};

}  // namespace burnish
