// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <span>

#include <burnish/reflectance/brdf.h>

namespace burnish::fixtures {

/// A surface that is unknown at some directions.
struct Gaps {
  BrdfRef whole;
  std::function<bool(Vec3 wi, Vec3 wo)> unknown;

  std::size_t channels() const noexcept { return whole.channels(); }
  bool isotropic() const noexcept { return whole.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    std::ranges::fill(f, 0.0);
    return !unknown(wi, wo) && whole.eval(wi, wo, f);
  }
};

}  // namespace burnish::fixtures
