// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/fitting/parametric/grain.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/gaps.h>

namespace burnish {
namespace {

using fixtures::Gaps;

TEST(GrainDirection, IsAlongTheLongestHighlights) {
  const auto of = [](const char* spec) { return grain_direction(parse_analytic(spec).ref()); };
  EXPECT_EQ(of("ggx:alpha_x=0.3,alpha_y=0.1"), 0);
  EXPECT_EQ(of("ggx:alpha_x=0.1,alpha_y=0.3"), 90);
  EXPECT_EQ(of("ggx:alpha_x=0.2,alpha_y=0.2"), 0);
  EXPECT_EQ(of("ggx:alpha_x=0.2,alpha_y=0.201"), 0);  // hardly
  for (const double angle : {20.0, 60.5, 115.0, 170.0})
    EXPECT_NEAR(
        of(fmt::format("openpbr:base_metalness=1,specular_roughness_anisotropy=0.8,geometry_tangent={}",
                       angle)
               .c_str()),
        angle, 0.5);
  // where azimuths are not known, from the others
  const AnalyticBrdf across = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3");
  const Gaps few{across.ref(), [](Vec3 wi, Vec3) { return wi.x * wi.y > 0.02; }};
  EXPECT_NEAR(grain_direction(few), 90, 1e-9);
  EXPECT_EQ(grain_direction(Gaps{across.ref(), [](Vec3, Vec3) { return true; }}), 0);
}

}  // namespace
}  // namespace burnish
