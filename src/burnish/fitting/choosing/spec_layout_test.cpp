#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/spec_layout.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

TEST(SpecLayout, VolumesFillTheirNodesInAboutTheirForm) {
  for (const VolumeForm& form : {VolumeForm{4, 2, 1}, {1, 1, 1}, {8, 1, 2}})
    for (const double nodes : {300.0, 1000.0, 7777.0, 100'000.0}) {
      const TableLayout layout = volume_of(form, nodes);
      ASSERT_NO_THROW(check_layout(layout, "g"));
      EXPECT_EQ(layout.warp, kHalfRootWarp);
      const auto found = static_cast<double>(layout.node_count());
      EXPECT_LE(found, nodes);
      // one node more along theta_h would be too many
      EXPECT_GT(found + layout.height * layout.depth, nodes);
      // sides are whole numbers, and the first two take up what rounding of the last leaves
      const double scale = std::cbrt(nodes / (form.half * form.difference * form.azimuth));
      EXPECT_NEAR(layout.depth, std::max(3.0, form.azimuth * scale), 0.5);
      EXPECT_NEAR(layout.height, std::sqrt(nodes / layout.depth * form.difference / form.half), 0.5);
    }
  EXPECT_LT(volume_of({1, 1, 1}, 5).width, 2);  // too few
}

TEST(SpecLayout, FewerNodesAreAboutTheShareOfVolumesAndDisksAlone) {
  const ModelSpec spec = parse_model_spec("v(theta_h,theta_d,phi_d) q(h) p(wo) p(wi)",
                                          std::vector<std::string>{"v=40x30x20", "q=60x60", "p=64"}, true);
  const ModelSpec fewer = at_fewer_nodes(spec, 0.125), same = at_fewer_nodes(spec, 1),
                  least = at_fewer_nodes(spec, 1e-9);
  ASSERT_EQ(spec.tables.size(), 3u);
  for (std::size_t t = 0; t < 3; ++t) {
    const TableLayout &layout = fewer.tables[t].layout, &before = spec.tables[t].layout;
    EXPECT_EQ(same.tables[t].layout, before);
    ASSERT_NO_THROW(check_layout(least.tables[t].layout, "t"));
    const double share = static_cast<double>(layout.node_count()) / static_cast<double>(before.node_count());
    if (before.shape == TableShape::line) {
      EXPECT_EQ(share, 1);
    } else {
      EXPECT_NEAR(share, 0.125, 0.005) << t;
    }
  }
}

TEST(SpecLayout, BytesAreTheModels) {
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model, TableFormat::half);
    const ModelSpec spec = parse_model_spec(model.expression, model.options, true);
    if (std::ranges::any_of(spec.tables, &ModelSpec::TableSpec::shared)) continue;  // texels of several sizes
    EXPECT_EQ(bytes_of(spec, 2 * model.channels, model.channels), brdf.bytes()) << model.name;
  }
}

}  // namespace
}  // namespace burnish
