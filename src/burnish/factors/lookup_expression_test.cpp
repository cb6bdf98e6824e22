#include <cmath>

#include <gtest/gtest.h>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/lookup_expression.h>
#include <burnish/testing/graph_values.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

// Positions as cells and fractions together, which borders of cells do not matter to.
TEST(LookupExpression, FindsWhatTheDefinitionFinds) {
  const auto pairs = corner_and_random_pairs(1000);
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    for (const Lobe& lobe : brdf.lobes())
      for (const FactorUse& use : lobe.factors) {
        const TableLayout& layout = brdf.tables()[static_cast<std::size_t>(use.table)].layout;
        const auto [x, y] =
            position_expressions(layout, use, {layout.width - 1.0, 0}, {layout.height - 1.0, 0});
        const CellExpr across = cell_expression(x, layout.width), up = cell_expression(y, layout.height);
        Graph graph;
        const std::size_t at_x = graph.add(across.node + across.fraction),
                          at_y = graph.add(up.node + up.fraction);
        for (const auto& [wi, wo] : pairs) {
          if (wi.z <= 0 || wo.z <= 0) continue;
          const auto values =
              graph_values(graph, {.values = {{"wi", {wi.x, wi.y, wi.z}}, {"wo", {wo.x, wo.y, wo.z}}}});
          const Lookup at = locate(layout, use, wi, wo);
          // single directions are unit vectors to 1e-7 only, which the two take in different ways
          const double tolerance = 3e-6 * layout.width * cancellation(brdf, wi, wo);
          EXPECT_NEAR(values[at_x][0], at.node % layout.width + at.fx, tolerance) << model.name;
          if (layout.shape == TableShape::line) continue;
          EXPECT_NEAR(values[at_y][0], at.node / layout.width + at.fy, tolerance) << model.name;
        }
      }
  }
}

}  // namespace
}  // namespace burnish
