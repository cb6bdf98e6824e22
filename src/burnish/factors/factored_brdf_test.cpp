// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

TEST(FactoredBrdf, IsReciprocalToTheLastBit) {
  const FactoredBrdf brdf = random_model(kEverything, kEverySize, 3, TableFormat::half);
  ASSERT_TRUE(brdf.reciprocal());
  std::array<double, 3> f, g;
  auto pairs = draw_pairs(5000, 2, false);
  pairs.push_back({{0, 0, 1}, normalize({1, 0, 1e-7})});
  pairs.push_back({normalize({1, 2, 3}), normalize({1, 2, 3})});
  for (const auto& [wi, wo] : pairs) {
    brdf.eval(wi, wo, f);
    brdf.eval(wo, wi, g);
    EXPECT_EQ(f, g);
    for (const double v : f) EXPECT_GT(v, 0);
  }
}

TEST(FactoredBrdf, KnowsWhatIsNotReciprocalOrIsotropic) {
  EXPECT_FALSE(random_model("a(wi)", {}, 1, TableFormat::half).reciprocal());
  EXPECT_FALSE(random_model("a(d)", {"a=8x8"}, 1, TableFormat::half).reciprocal());
  EXPECT_FALSE(random_model("a(m+wo)", {}, 1, TableFormat::half).reciprocal());
  EXPECT_FALSE(random_model("a(wi) a(wo) b(wi)", {}, 1, TableFormat::half).reciprocal());
  EXPECT_TRUE(random_model("a(wi) a(wo) b(h)", {}, 1, TableFormat::half).isotropic());
  EXPECT_FALSE(random_model("a(wi) a(wo) b(h)", {"b=8x8"}, 1, TableFormat::half).isotropic());
}

TEST(FactoredBrdf, IsTheProductOfItsLookups) {
  // At the nodes of p and r, and with h at the normal, the product is that of the stored values.
  const FactoredBrdf brdf =
      random_model("p(wo) q(h) r(theta_d) p(wi)", {"p=5", "q=7", "r=5"}, 3, TableFormat::single);
  for (int node = 0; node < 4; ++node) {
    const Vec3 wi = node_direction(brdf.tables()[0].layout, node, 0);
    std::array<double, 3> f;
    brdf.eval(wi, mirror(wi), f);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(node) * 3 + c;
      const double p = brdf.tables()[0].values[i], q = brdf.tables()[1].values[c],
                   r = brdf.tables()[2].values[i];
      EXPECT_NEAR(f[c], brdf.lobes()[0].scale[c] * p * p * q * r, 1e-6 * f[c]);
    }
  }
}

TEST(FactoredBrdf, InterpolatesLinearlyBetweenNodes) {
  Table table{.name = "q", .layout = {.shape = TableShape::disk, .width = 3, .height = 3}, .channels = 1};
  table.values = {1, 0.9f, 0.8f, 0.7f, 0.6f, 0.5f, 0.4f, 0.3f, 0.2f};
  const FactoredBrdf brdf(1, {table}, {{.scale = {2}, .factors = {{.table = 0, .projection = kProjectWi}}}},
                          TableFormat::single);
  double f;
  for (const auto& [wi, wo] : draw_pairs(500, 8, false)) {
    brdf.eval(wi, wo, {&f, 1});
    // these nine values lie on the plane 0.6 - 0.1 x - 0.3 y of the parabolic map
    EXPECT_NEAR(f, 2 * (0.6 - 0.1 * wi.x / (1 + wi.z) - 0.3 * wi.y / (1 + wi.z)), 1e-6);
  }
}

TEST(FactoredBrdf, InterpolatesAVolumeAlongEachOfItsAxes) {
  // values that are the product of three linear functions of the nodes are that product between them
  Table table{.name = "g",
              .layout = {.shape = TableShape::volume, .width = 5, .height = 4, .depth = 3},
              .channels = 1,
              .values = {}};
  const auto along_x = [](double u) { return 0.2 + 0.8 * u; };
  const auto along_y = [](double u) { return 1 - 0.5 * u; };
  const auto along_z = [](double u) { return 0.3 + 0.7 * u; };
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 5; ++x)
        table.values.push_back(static_cast<float>(along_x(x / 4.0) * along_y(y / 3.0) * along_z(z / 2.0)));
  const FactorUse use{.table = 0,
                      .projection = kProjectHalf,
                      .projection_y = kProjectDifference,
                      .projection_z = kProjectAzimuth};
  const FactoredBrdf brdf(1, {table}, {{.scale = {2}, .factors = {use}}}, TableFormat::single);
  EXPECT_TRUE(brdf.reciprocal());
  EXPECT_TRUE(brdf.isotropic());
  EXPECT_EQ(brdf.bytes(), 4u * (60 + 1));
  double f;
  for (const auto& [wi, wo] : draw_pairs(500, 8, false)) {
    brdf.eval(wi, wo, {&f, 1});
    const auto at = [&](const Projection& p) { return project_tan_half(p, wi, wo); };
    EXPECT_NEAR(
        f, 2 * along_x(at(kProjectHalf)) * along_y(at(kProjectDifference)) * along_z(at(kProjectAzimuth)),
        1e-6);
  }
}

TEST(FactoredBrdf, IsZeroBelowTheHorizon) {
  const FactoredBrdf brdf = random_model("pqp", {}, 3, TableFormat::half);
  std::array<double, 3> f;
  EXPECT_TRUE(brdf.eval({0, 0, -1}, {0, 0, 1}, f));
  EXPECT_EQ(f, (std::array<double, 3>{}));
  EXPECT_TRUE(brdf.eval({0, 0, 1}, {1, 0, 0}, f));
  EXPECT_EQ(f, (std::array<double, 3>{}));
}

TEST(FactoredBrdf, ScalesTablesToOneAndKeepsThemAboveTheFloor) {
  const FactoredBrdf brdf = random_model("pqp", {}, 3, TableFormat::half, 40);
  EXPECT_GE(brdf.smallest_factor(), kTableFloor);
  for (const Table& table : brdf.tables())
    for (std::size_t c = 0; c < 3; ++c) {
      float largest = 0;
      for (std::size_t i = c; i < table.values.size(); i += 3) largest = std::max(largest, table.values[i]);
      EXPECT_EQ(largest, 1);
    }
}

TEST(FactoredBrdf, ScalesTablesToOneInEveryFormat) {
  for (const TableFormat format : {TableFormat::rgb9e5, TableFormat::unorm8}) {
    const FactoredBrdf brdf = random_model("pqp", {}, 3, format, 40);
    for (const Table& table : brdf.tables()) {
      EXPECT_EQ(*std::ranges::max_element(table.values), 1);
      EXPECT_GE(*std::ranges::min_element(table.values),
                format == TableFormat::unorm8 ? 1.0f / 255 : 0x1p-24f);
    }
  }
}

TEST(FactoredBrdf, OneSpikeCostsTheOtherNodesNoPrecisionInRgb9e5) {
  Pcg32 random(8);
  Table table{.name = "q", .layout = {.width = 32}, .channels = 3};
  for (int i = 0; i < 96; ++i) table.values.push_back(static_cast<float>(0.5 * random.uniform() - i % 3));
  table.values[4] += 9;  // node 1, channel 1
  const Lobe lobe{.scale = {0, 0, 0}, .factors = {{.table = 0, .projection = kProjectWi}}};
  const FactoredBrdf brdf = from_log_tables(3, {table}, {lobe}, TableFormat::rgb9e5);
  // the means are moved by 9 / 32: channels of a texel differ by at most e^(0.5 + 9 / 32)
  const double bound = std::exp(0.5 + 9.0 / 32) / 511 + 1e-6;
  for (std::size_t i = 6; i < 96; ++i)
    EXPECT_NEAR(brdf.lobes()[0].scale[i % 3] * brdf.tables()[0].values[i] / std::exp(table.values[i]), 1,
                bound);
}

TEST(FactoredBrdf, CountsEachTableInItsFormat) {
  std::vector<Table> tables;
  for (const TableFormat format :
       {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8})
    tables.push_back({.name = std::string(to_string(format)),
                      .layout = {.width = 10},
                      .channels = 3,
                      .values = std::vector<float>(30, -1.0f),
                      .format = format});
  const Lobe lobe{.scale = {0, 0, 0}, .factors = {{.table = 0, .projection = kProjectWi}}};
  const FactoredBrdf brdf = from_log_tables(3, tables, {lobe});
  EXPECT_EQ(brdf.table_bytes(), 60u + 120 + 40 + 30);
  EXPECT_EQ(from_log_tables(3, tables, {lobe}, TableFormat::rgb9e5).table_bytes(), 160u);
}

TEST(FactoredBrdf, CountsItsBytes) {
  const FactoredBrdf pqp = random_model("pqp", {"p=32", "q=64"}, 3, TableFormat::half);
  EXPECT_EQ(pqp.table_bytes(), 576u);
  EXPECT_EQ(pqp.bytes(), 576u + 4 * 3 + 4);  // three scales, one warp parameter
  EXPECT_EQ(random_model("pqpr", {"p=32", "q=64", "r=32"}, 3, TableFormat::half).table_bytes(), 768u);
  EXPECT_EQ(random_model("a(wi+wo+0.5n)", {"a=10"}, 1, TableFormat::single).bytes(), 40u + 4 + 12);
}

TEST(FactoredBrdf, RefusesWhatDoesNotFit) {
  const Table good{.name = "p", .layout = {.width = 2}, .channels = 1, .values = {1, 0.5f}};
  const Lobe lobe{.scale = {1}, .factors = {{.table = 0, .projection = kProjectWi}}};
  EXPECT_NO_THROW(FactoredBrdf(1, {good}, {lobe}, TableFormat::half));
  const auto refused = [&](auto change_table, auto change_lobe) {
    Table table = good;
    Lobe l = lobe;
    change_table(table);
    change_lobe(l);
    EXPECT_THROW(FactoredBrdf(1, {table}, {l}, TableFormat::half), Error);
  };
  const auto keep = [](auto&) {};
  refused([](Table& t) { t.values = {1, 0}; }, keep);
  refused([](Table& t) { t.values = {1, NAN}; }, keep);
  refused([](Table& t) { t.values = {1}; }, keep);
  refused([](Table& t) { t.values = {1, 0.1f}; }, keep);  // not a half
  refused([](Table& t) { t.name = ""; }, keep);
  refused([](Table& t) { t.layout.width = 1; }, keep);
  refused([](Table& t) { t.layout.height = 3; }, keep);
  refused([](Table& t) { t.channels = 2; }, keep);
  refused(keep, [](Lobe& l) { l.scale = {-1}; });
  refused(keep, [](Lobe& l) { l.scale = {1, 1}; });
  refused(keep, [](Lobe& l) { l.factors[0].table = 1; });
  EXPECT_THROW(FactoredBrdf(1, {good}, {lobe}, TableFormat::rgb9e5), Error);
  EXPECT_THROW(FactoredBrdf(1, {good}, {lobe}, TableFormat::unorm8), Error);
  EXPECT_THROW(from_log_tables(1, {good}, {lobe}, TableFormat::rgb9e5), Error);
  EXPECT_THROW(FactoredBrdf(1, {good, good}, {lobe}, TableFormat::half), Error);
  EXPECT_THROW(FactoredBrdf(1, {good}, {}, TableFormat::half), Error);
}

}  // namespace
}  // namespace burnish
