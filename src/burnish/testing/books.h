// SPDX-License-Identifier: Apache-2.0
#pragma once

// Books for tests.

#include <cmath>
#include <string>
#include <vector>

#include <burnish/book/material_book.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/source.h>

namespace burnish {

/// Returns a book of random numbers: two materials, two components of brightness, one and none of colour.
inline MaterialBook random_book(std::uint64_t seed = 1) {
  constexpr std::size_t kNodes = 4 * 3 * 2;
  Pcg32 random(seed);
  const auto byte = [&] { return static_cast<std::int8_t>(static_cast<int>(255 * random.uniform()) - 127); };
  std::array<BookAxis, MaterialBook::kAxes> axes;
  const std::array<std::size_t, MaterialBook::kAxes> counts = {2, 1, 0};
  for (std::size_t u = 0; u < axes.size(); ++u) {
    // Means are multiples of an eighth, which halves hold exactly.
    for (std::size_t n = 0; n < kNodes; ++n)
      axes[u].mean.push_back(std::round(static_cast<float>(8 * random.uniform())) / 8 - (u == 0 ? 4 : 0.5f));
    axes[u].residual = 0.25f;
    for (std::size_t k = 0; k < counts[u]; ++k) {
      for (std::size_t n = 0; n < kNodes; ++n) axes[u].components.push_back(byte());
      axes[u].scales.push_back(0.0078125f);
      axes[u].steps.push_back(0.015625f);
      axes[u].deviations.push_back(0.75f);
    }
  }
  std::vector<MaterialBook::Material> materials;
  for (const char* name : {"felt", "paint"})
    materials.push_back({.name = name, .weights = {byte(), byte(), byte()}});
  return {{4, 3, 2}, std::move(axes), std::move(materials)};
}

/// Returns an analytic BRDF as open_source opens it.
inline Source analytic_source(const std::string& spec) {
  return {.name = spec, .brdf = parse_analytic(spec), .findings = {}};
}

}  // namespace burnish
