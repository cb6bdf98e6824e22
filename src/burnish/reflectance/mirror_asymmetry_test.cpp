// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {
namespace {

/// 5 exp(0.2) on one side of the plane of h and n, 5 exp(-0.2) on the other; nothing known beyond `least`.
struct TwoSides {
  double least = 0;

  static std::size_t channels() noexcept { return 2; }
  static bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = f[1] = 5 * std::exp(std::copysign(0.2, std::sin(2 * to_half_diff(wi, wo).phi_d)));
    return wi.z > least;
  }
};

TEST(MirrorAsymmetry, IsTheLeastErrorOfAModelThatIsItsOwnMirrorImage) {
  EXPECT_NEAR(mirror_asymmetry(TwoSides{}), 0.2, 1e-4);
  EXPECT_NEAR(mirror_asymmetry(TwoSides{0.5}), 0.2, 1e-4);
}

TEST(MirrorAsymmetry, IsNothingWhereThereIsNone) {
  EXPECT_LT(mirror_asymmetry(parse_analytic("ggx:alpha_x=0.1,alpha_y=0.1,kd=0.2").ref()), 1e-9);
  EXPECT_EQ(mirror_asymmetry(TwoSides{2}), 0);
}

}  // namespace
}  // namespace burnish
