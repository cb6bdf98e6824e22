// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/reflectance/analytic/ward.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

using fixtures::at;
using fixtures::grey;
using fixtures::kA;
using fixtures::kB;
using fixtures::kNormal;

TEST(Ward, AgreesInAllNormalizationsAtNormalIncidence) {
  for (const auto n : {Ward::Normalization::ward, Ward::Normalization::duer, Ward::Normalization::bounded})
    EXPECT_NEAR(grey(Ward{0.2, 0.5, 0, 1, n}, kNormal, kNormal), 1 / (4 * kPi * 0.1), 1e-14);
}

TEST(Ward, MatchesReferenceValues) {
  EXPECT_NEAR(grey(Ward{0.3, 0.5, 0, 1, Ward::Normalization::ward}, kA, kB), 0.5052092823348826, 1e-14);
  EXPECT_NEAR(grey(Ward{0.3, 0.5, 0, 1, Ward::Normalization::duer}, kA, kB), 0.6962341369030941, 1e-14);
  EXPECT_NEAR(grey(Ward{0.3, 0.5, 0, 1, Ward::Normalization::bounded}, kA, kB), 0.7357877505675455, 1e-14);
  EXPECT_NEAR(albedo(Ward{0.3, 0.5, 0, 1, Ward::Normalization::bounded}, at(60, 30)), 0.7562699577939842,
              1e-3);
}

TEST(Ward, ExceedsUnitAlbedoAtGrazingAnglesUnlessBounded) {
  EXPECT_GT(albedo(Ward{0.3, 0.3, 0, 1, Ward::Normalization::duer}, at(88, 0)), 2);
  EXPECT_LT(albedo(Ward{0.3, 0.3, 0, 1, Ward::Normalization::bounded}, at(88, 0)), 1);
}

}  // namespace
}  // namespace burnish
