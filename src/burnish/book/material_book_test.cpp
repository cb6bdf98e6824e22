// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/books.h>

namespace burnish {
namespace {

TEST(MaterialBook, GivesReciprocalPositiveModelsThatMirrorThemselves) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const MaterialBook book = random_book(seed);
    const FactoredBrdf brdf = book.brdf(1);
    EXPECT_TRUE(brdf.reciprocal());
    std::array<double, 3> f{}, swapped{}, mirrored{};
    for (const auto& [wi, wo] : draw_pairs(200, seed, false)) {
      brdf.eval(wi, wo, f);
      brdf.eval(wo, wi, swapped);
      brdf.eval({wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}, mirrored);
      EXPECT_EQ(f, swapped);
      EXPECT_EQ(f, mirrored);
      EXPECT_GT(*std::ranges::min_element(f), 0);
    }
  }
}

TEST(MaterialBook, HasTheLogarithmsThatItSays) {
  const MaterialBook book = random_book();
  const auto weights = book.weights(0);
  const std::vector<double> logs = book.logs(weights);
  // the sum by its definition, at one node
  const std::size_t node = 13;
  for (std::size_t c = 0; c < 3; ++c) {
    double expected = 0;
    for (std::size_t u = 0; u < 3; ++u) {
      const BookAxis& axis = book.axes()[u];
      double of_axis = static_cast<double>(axis.mean[node]);
      for (std::size_t k = 0; k < axis.component_count(); ++k)
        of_axis += weights[u][k] * static_cast<double>(axis.scales[k]) *
                   axis.components[k * book.node_count() + node];
      expected += kBookAxes[u][c] * of_axis;
    }
    EXPECT_NEAR(logs[node * 3 + c], expected, 1e-12);
  }
}

TEST(MaterialBook, IsLinearInLogarithmsHalfwayBetweenNodes) {
  const MaterialBook book = random_book();
  const FactoredBrdf brdf = book.brdf(0, TableFormat::single);
  const Table &line = brdf.tables()[0], &volume = brdf.tables()[1];
  const auto width = static_cast<std::size_t>(volume.layout.width);
  ASSERT_EQ(volume.layout.height, 2 * book.layout().height - 1);
  ASSERT_EQ(volume.layout.depth, 2 * book.layout().depth - 1);
  const auto raised = [&](std::size_t x, std::size_t y) {
    return brdf.lobes()[0].scale[0] *
               static_cast<double>(line.values[x] * volume.values[(y * width + x) * 3]) +
           MaterialBook::kFloor;
  };
  for (std::size_t x = 0; x < width; ++x)
    EXPECT_NEAR(raised(x, 1), std::sqrt(raised(x, 0) * raised(x, 2)), 1e-3 * raised(x, 1)) << x;
}

TEST(MaterialBook, RefusesWhatDoesNotFit) {
  const MaterialBook book = random_book();
  auto axes = book.axes();
  const std::vector<MaterialBook::Material> materials(book.materials().begin(), book.materials().end());
  axes[0].steps[0] = 0;
  EXPECT_THROW(MaterialBook({4, 3, 2}, axes, materials), Error);
  EXPECT_THROW(MaterialBook({4, 3, 3}, book.axes(), materials), Error);
  EXPECT_THROW(MaterialBook({4, 3, 2}, book.axes(), {materials[0], materials[0]}), Error);
  EXPECT_THROW(MaterialBook({4, 3, 2}, book.axes(), {{.name = "short", .weights = {1}}}), Error);
  EXPECT_EQ(book.find("paint"), 1u);
  EXPECT_FALSE(book.find("pain"));
}

TEST(MaterialBook, SharesOfNodesAreThePairsLookup) {
  const TableLayout layout = book_layout({5, 4, 3});
  Pcg32 random(4);
  Table table{.name = "g", .layout = layout, .channels = 1, .values = {}};
  for (std::size_t n = 0; n < layout.node_count(); ++n)
    table.values.push_back(static_cast<float>(0.1 + 0.9 * random.uniform()));
  FactorUse use = book_use();
  use.table = 0;
  const FactoredBrdf brdf(1, {table}, {{.scale = {1}, .factors = {use}}});
  double f;
  for (const DirectionPair& pair : draw_pairs(200, 5, false)) {
    brdf.eval(pair.wi, pair.wo, {&f, 1});
    double sum = 0, all = 0;
    for (const auto& [node, share] : book_nodes(layout, pair)) {
      EXPECT_GE(share, 0);
      all += share;
      if (share > 0) sum += share * static_cast<double>(table.values.at(node));
    }
    EXPECT_NEAR(all, 1, 1e-12);
    EXPECT_NEAR(sum, f, 1e-12);
  }
}

}  // namespace
}  // namespace burnish
