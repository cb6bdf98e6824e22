// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TEST(LayOut, VolumesFillTheirNodesInAboutTheirForm) {
  for (const VolumeForm& form : {VolumeForm{4, 2, 1}, {1, 1, 1}, {8, 1, 2}})
    for (const double nodes : {300.0, 1000.0, 7777.0, 100'000.0}) {
      const TableLayout layout = volume_of(form, nodes);
      ASSERT_NO_THROW(check_layout(layout, "g"));
      EXPECT_EQ(layout.warp, kHalfRootWarp);
      const auto found = static_cast<double>(layout.node_count());
      EXPECT_LE(found, nodes);
      // One more node along theta_h would be too many.
      EXPECT_GT(found + layout.height * layout.depth, nodes);
      // Sides are whole numbers. The first two sides absorb the rounding of the last one.
      const double scale = std::cbrt(nodes / (form.half * form.difference * form.azimuth));
      EXPECT_NEAR(layout.depth, std::max(3.0, form.azimuth * scale), 0.5);
      EXPECT_NEAR(layout.height, std::sqrt(nodes / layout.depth * form.difference / form.half), 0.5);
    }
  EXPECT_LT(volume_of({1, 1, 1}, 5).width, 2);  // too few
}

TEST(LayOut, FewerNodesAreAboutTheShareOfVolumesAndDisksAlone) {
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

TEST(LayOut, ProductsFillTheirBytesAndLeaveOutWhatTheyDoNotHold) {
  const ProductForm form{
      .model = "p(wo) p(wi) q(h) v(theta_h,theta_d,phi_s)", .border = 0.065, .difference = 0.1};
  for (const std::size_t bytes : {4'000u, 20'000u}) {
    const CostLimit limit{.bytes = bytes, .texel_bytes = 4, .fetches = 1};
    const ModelSpec spec = lay_out(form, limit, 3).value();
    const std::size_t taken = model_bytes(spec, 3, limit.texel_bytes);
    EXPECT_LE(taken, bytes);
    EXPECT_GT(taken, bytes * 9 / 10);
  }
  EXPECT_FALSE(lay_out(form, {.bytes = 100}, 3));
}

/// Returns FactoredBrdf::bytes of a model with this spec.
std::size_t bytes_in_the_end(const ModelSpec& spec, std::size_t channels, TableFormat format) {
  LogModel model{.spec = spec, .channels = channels, .log_values = {}};
  for (const ModelSpec::TableSpec& table : spec.tables)
    model.log_values.emplace_back((table.shared ? 1 : channels) * table.layout.node_count());
  return to_brdf(model, format).bytes();
}

TEST(LayOut, EveryFamilyOfModelsCountsTheBytesThatItTakes) {
  const AnalyticBrdf round = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3");
  const fixtures::Ordered ordered{{.a = 10, .b = 10}};
  const fixtures::Twisted twisted{{.a = 10, .b = 10}};
  for (const TableFormat format : {TableFormat::half, TableFormat::rgb9e5, TableFormat::unorm8})
    for (const std::size_t bytes : {2'700u, 9'000u, 40'000u}) {
      const std::size_t texel = texel_bytes(format, 3);
      const CostLimit limit{.bytes = bytes, .texel_bytes = texel, .fetches = 6};
      std::vector<ModelSpec> specs;
      const auto add = [&](const std::vector<ModelSpec>& further) {
        specs.insert(specs.end(), further.begin(), further.end());
      };
      for (const BrdfRef source : {round.ref(), BrdfRef(ordered), BrdfRef(twisted)}) {
        add(volume_specs(source, limit));
        add({plan_to_spec(plan_for(source, bytes, 0, texel), bytes, 3, texel)});
      }
      if (bytes > 5'000) add(hemisphere_specs(limit, 3));
      LobePlan lobes = default_plan(bytes, 3, false, texel);
      lobes.factors.front().grey = true;
      add({plan_to_spec(lobes, bytes, 3, texel)});
      for (const ModelSpec& spec : specs) {
        const std::size_t taken = bytes_in_the_end(spec, 3, format);
        EXPECT_EQ(model_bytes(spec, 3, format), taken);
        EXPECT_EQ(model_bytes(spec, 3, texel), taken);
        EXPECT_LE(taken, bytes);
      }
    }
}

}  // namespace
}  // namespace burnish
