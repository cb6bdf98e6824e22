// SPDX-License-Identifier: Apache-2.0
#include <array>
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
        const TableLayout& layout = brdf.tables()[use.table].layout;
        const int nodes[3] = {layout.width, layout.height, layout.depth};
        const auto positions =
            position_expressions(layout, use, {nodes[0] - 1.0, 0}, {nodes[1] - 1.0, 0}, {nodes[2] - 1.0, 0});
        Graph graph;
        std::array<std::size_t, 3> found{};
        for (std::size_t k = 0; k < 3; ++k) {
          const CellExpr cell = cell_expression(positions[k], nodes[k]);
          found[k] = graph.add(cell.node + cell.fraction);
        }
        for (const auto& [wi, wo] : pairs) {
          if (wi.z <= 0 || wo.z <= 0) continue;
          const auto values =
              graph_values(graph, {.values = {{"wi", {wi.x, wi.y, wi.z}}, {"wo", {wo.x, wo.y, wo.z}}}});
          const Lookup at = locate(layout, use, wi, wo);
          // single directions are unit vectors to 1e-7 only, which the two take in different ways
          const double scale = 3e-6 * shader_cancellation(brdf, wi, wo);
          const int row = at.node / layout.width;
          const double expected[3] = {at.node % layout.width + at.fx, row % layout.height + at.fy,
                                      row / layout.height + at.fz};
          for (std::size_t k = 0; k < static_cast<std::size_t>(axis_count(layout.shape)); ++k)
            EXPECT_NEAR(values[found[k]][0], expected[k], scale * nodes[k]) << model.name << " axis " << k;
        }
      }
  }
}

}  // namespace
}  // namespace burnish
