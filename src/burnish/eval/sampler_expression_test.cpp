// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/eval/sampler_expression.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/directions.h>
#include <burnish/testing/graph_values.h>

namespace burnish {
namespace {

TEST(SamplerExpression, DrawsAndWeighsAsTheSamplerDoes) {
  for (const char* spec : {"ggx:alpha_x=0.2,alpha_y=0.2", "ggx:alpha_x=0.1,alpha_y=0.3"}) {
    const AnalyticBrdf brdf = parse_analytic(spec);
    const TabulatedSampler sampler{BrdfRef(brdf)};
    const SamplerTables tables = sampler.tables();
    const DrawnExpr drawn = sample_expression(tables);
    Graph draw, density;
    std::size_t outputs[4];
    const Expr* const each[] = {&drawn.x, &drawn.y, &drawn.z, &drawn.pdf};
    for (std::size_t k = 0; k < 4; ++k) outputs[k] = draw.add(*each[k]);
    const std::size_t found = density.add(pdf_expression(tables));
    GraphInputs inputs{
        .values = {}, .element = [&](const std::string& name, int i) -> double {
          return (name == "row_edges" ? tables.row_edges : tables.cell_edges)[static_cast<std::size_t>(i)];
        }};
    Pcg32 random(3);
    int same = 0;
    constexpr int kDraws = 500;
    for (int i = 0; i < kDraws; ++i) {
      const Vec3 wo = random_upper_direction(random);
      const Point2 u{random.uniform(), random.uniform()};
      inputs.values = {{"wo_x", {wo.x}}, {"wo_y", {wo.y}}, {"wo_z", {wo.z}}, {"u_x", {u.x}}, {"u_y", {u.y}}};
      const DrawnDirection expected = sampler.sample_wi(wo, u);
      const auto values = graph_values(draw, inputs);
      const Vec3 wi{values[outputs[0]][0], values[outputs[1]][0], values[outputs[2]][0]};
      // The sampler searches in float, so some draws land on the other side of a cell's border.
      same += length(wi - expected.wi) < 1e-5 && std::abs(values[outputs[3]][0] / expected.pdf - 1) < 1e-4;

      inputs.values = {{"wi_x", {expected.wi.x}}, {"wi_y", {expected.wi.y}}, {"wi_z", {expected.wi.z}},
                       {"wo_x", {wo.x}},          {"wo_y", {wo.y}},          {"wo_z", {wo.z}}};
      const double pdf = sampler.pdf(expected.wi, wo);
      EXPECT_NEAR(graph_values(density, inputs)[found][0], pdf, 1e-9 * pdf) << spec;
    }
    EXPECT_GE(same, 0.99 * kDraws) << spec;
  }
}

}  // namespace
}  // namespace burnish
