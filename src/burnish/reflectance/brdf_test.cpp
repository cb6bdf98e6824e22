// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {
namespace {

/// wi.x - wo.x - 0.1 in one channel, its negative in the other, unknown where wi.y < -0.5.
struct Signed {
  std::size_t channels() const noexcept { return 2; }
  bool isotropic() const noexcept { return false; }
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = wi.x - wo.x - 0.1;
    f[1] = -f[0];
    return !(wi.y < -0.5);
  }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const bool known = eval_raw(wi, wo, f);
    cut_negatives(f);
    return known;
  }
};

static_assert(HasRawValues<Signed>);

using Values = std::array<double, 2>;

Values value_of(BrdfRef brdf, Vec3 wi, Vec3 wo) {
  Values f;
  EXPECT_TRUE(brdf.eval(wi, wo, f));
  return f;
}

const Vec3 kA = spherical_direction(0.9, 0), kB = spherical_direction(0.3, 1);

TEST(BrdfRef, UnclampedGivesRawValuesWhereThereAreSome) {
  const Signed brdf;
  const double x = kA.x - kB.x - 0.1;
  ASSERT_GT(x, 0);
  EXPECT_EQ(value_of(brdf, kA, kB), (Values{x, 0}));
  EXPECT_EQ(value_of(BrdfRef(brdf).unclamped(), kA, kB), (Values{x, -x}));
  EXPECT_EQ(value_of(BrdfRef(brdf).unclamped().unclamped(), kA, kB), (Values{x, -x}));
}

TEST(SymmetrizedBrdf, AveragesWhatTheOwnerEvaluatesAndRawValuesRaw) {
  const Signed brdf;
  const SymmetrizedBrdf symmetrized{brdf};
  const double x = kA.x - kB.x;
  for (const auto& [wi, wo] : {DirectionPair{kA, kB}, DirectionPair{kB, kA}}) {
    const Values cut = value_of(symmetrized, wi, wo),
                 raw = value_of(BrdfRef(symmetrized).unclamped(), wi, wo);
    EXPECT_NEAR(cut[0], 0.5 * (x - 0.1), 1e-15);
    EXPECT_NEAR(cut[1], 0.5 * (x + 0.1), 1e-15);
    EXPECT_NEAR(raw[0], -0.1, 1e-15);
    EXPECT_NEAR(raw[1], 0.1, 1e-15);
  }
  // the order that is known
  const Vec3 unknown = spherical_direction(0.9, -kHalfPi);
  EXPECT_EQ(value_of(BrdfRef(symmetrized).unclamped(), unknown, kA),
            value_of(BrdfRef(brdf).unclamped(), kA, unknown));
}

}  // namespace
}  // namespace burnish
