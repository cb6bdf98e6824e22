// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {
namespace {

/// c / pi, known only where wo.x > 0 if `half`.
struct Diffuse {
  bool half = false;

  std::size_t channels() const noexcept { return 2; }
  bool isotropic() const noexcept { return false; }
  bool eval(Vec3, Vec3 wo, std::span<double> f) const noexcept {
    const bool known = !half || wo.x > 0;
    f[0] = known ? 0.5 / kPi : 0;
    f[1] = 2 * f[0];
    return known;
  }
};

struct Skewed {
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = wi.z > wo.z ? 3 : 1;
    return true;
  }
};

TEST(ReciprocityError, IsTheMeanRelativeAsymmetry) {
  EXPECT_EQ(reciprocity_error(Diffuse{}, 500, 1).mean, 0);
  EXPECT_EQ(reciprocity_error(Diffuse{}, 500, 1).pairs, 500u);
  EXPECT_NEAR(reciprocity_error(Skewed{}, 500, 1).mean, 1, 1e-12);
  const auto half = reciprocity_error(Diffuse{true}, 500, 1);
  EXPECT_LT(half.pairs, 300u);
}

}  // namespace
}  // namespace burnish
