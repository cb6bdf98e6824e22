// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/eval/factored_plan.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

/// A slot's position and its projection; a disk's second slot has the position of the first.
struct SlotOwner {
  const FactoredPlan::Source* source;
  const FactoredPlan::Position* position;
};

/// Returns owners by slot; fails if two positions share a slot.
std::map<std::size_t, SlotOwner> slot_owners(const FactoredPlan& plan) {
  std::map<std::size_t, SlotOwner> owners;
  for (const auto& source : plan.sources)
    for (const auto& position : source.positions)
      for (std::size_t k = 0; k < (position.disk ? 2 : 1); ++k)
        EXPECT_TRUE(owners.insert({position.slot + k, {&source, &position}}).second) << position.slot + k;
  return owners;
}

// The plan has what each lookup of each lobe needs, and each position once.
TEST(FactoredPlan, LooksUpWhereTheModelDoes) {
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    const FactoredPlan plan(brdf);
    const auto owners = slot_owners(plan);
    EXPECT_EQ(owners.size(), plan.slots) << model.name;
    ASSERT_EQ(plan.products.size(), brdf.lobes().size());
    for (std::size_t j = 0; j < plan.products.size(); ++j) {
      std::size_t k = plan.products[j].first;
      bool second = false;  // the second use of a pair
      for (const FactorUse& use : brdf.ordered_factors(j)) {
        ASSERT_LT(k, plan.products[j].last);
        const FactoredPlan::Lookup& lookup = plan.lookups[k];
        const TableLayout& layout = brdf.table_of(use).layout;
        const auto& slots = second ? lookup.pair_at : lookup.at;
        const Projection projections[] = {use.projection, use.projection_y, use.projection_z};
        const int sides[] = {layout.width, layout.height, layout.depth};
        const Warp warps[] = {layout.warp, layout.warp_y, layout.warp_z};
        for (int axis = 0; axis < axis_count(layout.shape); ++axis) {
          const bool disk = layout.shape == TableShape::disk;
          const auto& [source, position] = owners.at(slots[static_cast<std::size_t>(axis)]);
          EXPECT_EQ(source->projection, projections[disk ? 0 : axis]) << model.name;
          EXPECT_EQ(position->disk, disk) << model.name;
          EXPECT_EQ(position->cells, static_cast<float>(sides[axis] - 1)) << model.name;
          EXPECT_EQ(position->warp, warps[disk ? 0 : axis].kind) << model.name;
        }
        second = lookup.pair && !second;
        if (!second) ++k;
      }
      EXPECT_EQ(k, plan.products[j].last) << model.name;
    }
  }
}

TEST(FactoredPlan, HoldsTheTablesValues) {
  std::vector<ModelCase> models(std::begin(kModelCases), std::end(kModelCases));
  models.push_back({"SevenChannels", "p(wo) q(h) p(wi) r(theta_d)", {"p=8", "q=9x9", "r=200,shared"}, 7});
  for (const ModelCase& model : models) {
    const FactoredBrdf brdf = smooth_model(model);
    const FactoredPlan plan(brdf);
    for (std::size_t j = 0, k = 0; j < plan.products.size(); ++j)
      for (std::size_t i = 0; i < brdf.ordered_factors(j).size(); ++i, ++k) {
        const FactoredPlan::Lookup& lookup = plan.lookups[k];
        if (lookup.pair) ++i;
        const Table& table = brdf.table_of(brdf.ordered_factors(j)[i]);
        EXPECT_EQ(lookup.shared, table.channels == 1);
        for (std::size_t at = 0; at < table.values.size(); ++at) {
          const std::size_t node = at / table.channels, c = at % table.channels;
          const auto row = [&](std::size_t channel) {
            return plan.values[lookup.rows + channel / 3 * lookup.next_group +
                               node * FactoredPlan::kRowStride + channel % 3];
          };
          EXPECT_EQ(row(c), table.values[at]) << model.name;
          if (lookup.shared) {
            EXPECT_EQ(row(2), table.values[at]) << model.name;
          }
          if (lookup.planes == 0) continue;
          const std::size_t plane = lookup.plane_vectors * FactoredPlan::kPlaneVector;
          ASSERT_GE(plane, table.layout.node_count());
          EXPECT_EQ(plan.values[lookup.planes + c * plane + node], table.values[at]) << model.name;
        }
      }
  }
}

TEST(FactoredPlan, FindsWhatLobesShare) {
  const auto plan_of = [](const char* expression, const std::vector<std::string>& tables) {
    return FactoredPlan(random_model(expression, tables, 3, TableFormat::single));
  };
  // Both directions of a pair share one lookup with two positions.
  const FactoredPlan pqp = plan_of("p(wo) q(h) p(wi)", {"p=8", "q=9"});
  EXPECT_EQ(pqp.lookups.size(), 2u);
  EXPECT_EQ(pqp.slots, 3u);
  // Tables and lobes with equal numbers of cells share one position of h; other numbers have another position.
  EXPECT_EQ(plan_of("q(h) r(h) + s(h)", {"q=9", "r=9", "s=9"}).slots, 1u);
  EXPECT_EQ(plan_of("q(h) r(h) + s(h)", {"q=9", "r=8", "s=9,power:0.5"}).slots, 3u);
  // A power of one angle is computed once for two numbers of nodes.
  const FactoredPlan powers = plan_of("q(h) r(h)", {"q=9,power:0.3", "r=8,power:0.3"});
  ASSERT_EQ(powers.sources.size(), 1u);
  ASSERT_EQ(powers.sources[0].positions.size(), 2u);
  EXPECT_FALSE(powers.sources[0].positions[0].shares_power);
  EXPECT_TRUE(powers.sources[0].positions[1].shares_power);
  // The fast path of two fetches is used only for its form.
  EXPECT_TRUE(plan_of("z(h) v(theta_h,theta_d,phi_d)", {"z=9,power:0.5", "v=4x4x3"}).volume_and_line);
  EXPECT_TRUE(plan_of("v(theta_h,theta_d,phi_d)", {"v=4x4x3"}).volume_and_line);
  EXPECT_FALSE(plan_of("z(h) v(theta_d,theta_h,phi_d)", {"z=9,power:0.5", "v=4x4x3"}).volume_and_line);
  EXPECT_FALSE(plan_of("z(theta_d) v(theta_h,theta_d,phi_d)", {"z=9,power:0.5", "v=4x4x3"}).volume_and_line);
  EXPECT_FALSE(plan_of("z(h) v(theta_h,theta_d,phi_d)", {"z=9,rational:0.2", "v=4x4x3"}).volume_and_line);
}

TEST(FactoredPlan, RefusesMorePositionsThanItsKernelsHold) {
  // The model has lines of h, each with another number of nodes.
  const auto lines = [](std::size_t count) {
    std::vector<Table> tables;
    Lobe lobe{.scale = {1}, .factors = {}};
    for (std::size_t t = 0; t < count; ++t) {
      tables.push_back({.name = "t" + std::to_string(t),
                        .layout = {.width = static_cast<int>(t) + 2},
                        .channels = 1,
                        .values = std::vector<float>(t + 2, 1.0f)});
      lobe.factors.push_back({.table = t, .projection = kProjectHalf});
    }
    return FactoredBrdf(1, std::move(tables), {std::move(lobe)});
  };
  EXPECT_EQ(FactoredPlan(lines(FactoredPlan::kMaxSlots)).slots, FactoredPlan::kMaxSlots);
  EXPECT_THROW(FactoredPlan(lines(FactoredPlan::kMaxSlots + 1)), Error);
}

}  // namespace
}  // namespace burnish
