// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/model_spec.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

TEST(ModelSpec, ReadsWhatModelExpressionPrints) {
  for (const char* expression : {"pqp", "pqpr", kEverything}) {
    const FactoredBrdf brdf = random_model(expression, {}, 1, TableFormat::half);
    const FactoredBrdf again = random_model(model_expression(brdf).c_str(), {}, 1, TableFormat::half);
    EXPECT_EQ(model_expression(again), model_expression(brdf));
  }
}

TEST(ModelSpec, ReadsFormats) {
  const std::vector<std::string> options{"p=8,unorm8", "q=8,rational:0.5,shared"};
  const ModelSpec spec = parse_model_spec("pqpr", options, true);
  EXPECT_EQ(format_of(spec.tables[0], TableFormat::half), TableFormat::unorm8);
  EXPECT_EQ(format_of(spec.tables[1], TableFormat::rgb9e5), TableFormat::half);  // shared: one channel
  EXPECT_EQ(format_of(spec.tables[2], TableFormat::rgb9e5), TableFormat::rgb9e5);
}

TEST(ModelSpec, ReadsVolumes) {
  const std::vector<std::string> options{"g=9x5x4,power:0.4,identity,rational:0.3"};
  const ModelSpec spec =
      parse_model_spec("z(theta_h) g(theta_h,theta_d,phi_d) + w(h,d,phi_d)", options, false);
  const TableLayout& g = spec.tables[1].layout;
  EXPECT_EQ(g, (TableLayout{.shape = TableShape::volume,
                            .width = 9,
                            .height = 5,
                            .depth = 4,
                            .warp = {WarpKind::power, 0.4},
                            .warp_y = {},
                            .warp_z = {WarpKind::rational, 0.3}}));
  EXPECT_EQ(spec.lobes[0][1].projection_y, kProjectDifference);
  EXPECT_EQ(spec.lobes[0][1].projection_z, kProjectAzimuth);
  EXPECT_EQ(spec.tables[2].layout.shape, TableShape::volume);
  EXPECT_EQ(spec.tables[2].layout.warp, (Warp{WarpKind::power, 0.5}));
  for (const char* option : {"g=9", "g=9x5", "g=9x5x1", "g=9x5x4x2", "g=300x5x4", "g=9x200x200",
                             "g=9x5x4,identity,identity,identity,identity"})
    EXPECT_THROW(parse_model_spec("g(theta_h,theta_d,phi_d)", std::vector<std::string>{option}, true), Error)
        << option;
  EXPECT_THROW(parse_model_spec("g(theta_h,theta_d,phi_d,h)", {}, true), Error);
}

TEST(ModelSpec, RefusesWhatItDoesNotKnow) {
  for (const char* expression :
       {"", "p", "p(", "p(wi", "p(wi)+", "p()", "(wi)", "p(wi) q", "p(theta_q)", "p(h,)"})
    EXPECT_THROW(parse_model_spec(expression, {}, true), Error) << expression;
  for (const char* option :
       {"p", "=3", "p=", "p=1", "p=4x", "p=4x5", "p=4x4x4", "p=4,what", "p=99999", "z=4", "p=4,rational:0"})
    EXPECT_THROW(parse_model_spec("pqp", std::vector<std::string>{option}, true), Error) << option;
  EXPECT_THROW(parse_model_spec("pqp", std::vector<std::string>{"p=4", "p=5"}, true), Error);
  EXPECT_THROW(parse_model_spec("pqpr", std::vector<std::string>{"r=8x8"}, true), Error);
}

TEST(ModelSpec, StoresATableOfOneNameOnceAndChecksItsShape) {
  const ModelSpec spec = parse_model_spec("p(wo) q(h) p(wi) + q(h)", {}, false);
  ASSERT_EQ(spec.tables.size(), 2u);
  EXPECT_EQ(spec.lobes[0][0].table, spec.lobes[0][2].table);
  EXPECT_EQ(spec.lobes[0][1].table, spec.lobes[1][0].table);
  EXPECT_EQ(spec.tables[0].layout.shape, TableShape::disk);  // anisotropic: over azimuths too
  EXPECT_THROW(parse_model_spec("p(wo) p(theta_h,theta_d)", {}, true), Error);
}

}  // namespace
}  // namespace burnish
