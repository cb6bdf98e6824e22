// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/energy.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/metrics/albedo.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

// Few directions: sanitized builds are slow.
constexpr EnergyOptions kCoarse{.theta_count = 10, .phi_count = 12};

/// Returns a model whose tables over wi and wo rise towards the horizon by e^rise, most of it near grazing. Its other
/// tables fall by e^-fall, with some noise. Its albedo at the normal is `level` in the first channel, and less in the
/// other channels.
FactoredBrdf steep_model(const char* expression, std::vector<std::string> options, TableFormat format,
                         double rise, double level, double fall = 3) {
  constexpr std::size_t channels = 3;
  Pcg32 random(4);
  const ModelSpec spec = parse_model_spec(expression, options, true);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = t.shared ? std::size_t{1} : 3, .values = {}};
    table.format = format_of(t, format);
    const auto height = [&](double tan_half) {
      return t.name == "p" ? rise * std::pow(tan_half, 4) : -fall * tan_half;
    };
    for (int y = 0; y < t.layout.height; ++y)
      for (int x = 0; x < t.layout.width; ++x)
        for (std::size_t c = 0; c < table.channels; ++c)
          table.values.push_back(static_cast<float>(height(tan_half_theta(node_direction(t.layout, x, y))) +
                                                    0.02 * random.uniform()));
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes)
    lobes.push_back({.scale = std::vector<double>(channels, 0.0), .factors = factors});
  const FactoredBrdf unscaled = from_log_tables(3, tables, lobes);
  const double albedo = directional_albedo(unscaled, {0, 0, 1}).albedo[0];
  for (Lobe& lobe : lobes)
    for (std::size_t c = 0; c < channels; ++c)
      lobe.scale[c] = std::log(level / albedo) - 0.3 * static_cast<double>(c);
  return from_log_tables(3, std::move(tables), std::move(lobes));
}

double largest_albedo(const FactoredBrdf& brdf, std::size_t count) {
  Pcg32 random(9);
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = radians(89.5) * random.uniform(), phi = kTwoPi * random.uniform();
    const DirectionalAlbedo at = directional_albedo(brdf, spherical_direction(theta, phi));
    largest = std::max(largest, std::ranges::max(at.albedo));
  }
  return largest;
}

struct Case {
  const char* model;
  std::vector<std::string> tables;
  TableFormat format;
};

class Energy : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Models, Energy,
                         testing::Values(Case{"pqp", {"p=16", "q=16"}, TableFormat::half},
                                         Case{"pqp", {"p=16,shared", "q=16"}, TableFormat::rgb9e5},
                                         Case{"p(wo) q(h) p(wi) + s(h) g(theta_h,theta_d)",
                                              {"p=16", "q=16", "s=8", "g=4x4"},
                                              TableFormat::unorm8},
                                         Case{"q(h) r(theta_d)", {"q=16", "r=8"}, TableFormat::single},
                                         Case{"p(wo) q(h) p(wi)", {"p=7x7", "q=9x9"}, TableFormat::half}));

TEST_P(Energy, AlbedosEndAtOneAndReciprocityStays) {
  const FactoredBrdf brdf = steep_model(GetParam().model, GetParam().tables, GetParam().format, 2, 1.4);
  const EnergyConservation kept = conserve_energy(brdf, kCoarse);
  EXPECT_GT(kept.largest_before[0], 1.3);
  for (const double a : kept.largest_after) EXPECT_LE(a, 1);
  EXPECT_LE(largest_albedo(kept.brdf, 8), 1 + 2 * kCoarse.tolerance);
  EXPECT_EQ(kept.brdf.bytes(), brdf.bytes());
  EXPECT_TRUE(kept.brdf.reciprocal());
  std::array<double, 3> f, g;
  for (const auto& [wi, wo] : draw_pairs(300, 2, false)) {
    kept.brdf.eval(wi, wo, f);
    kept.brdf.eval(wo, wi, g);
    EXPECT_EQ(f, g);
    for (const double v : f) EXPECT_GT(v, 0);
  }
}

TEST_P(Energy, WhatConservesItComesBackAsItIs) {
  const FactoredBrdf brdf = steep_model(GetParam().model, GetParam().tables, GetParam().format, 0, 0.3);
  const EnergyConservation kept = conserve_energy(brdf, kCoarse);
  EXPECT_TRUE(kept.brdf == brdf);
  EXPECT_EQ(kept.iterations, 0);
  EXPECT_EQ(kept.largest_after, kept.largest_before);
}

TEST(EnergyCost, DampedDirectionsReflectAllAndOthersKeepTheirs) {
  // A glossy lobe that exceeds 1 towards the horizon alone.
  const FactoredBrdf brdf =
      steep_model("pqp", {"p=48", "q=32,rational:0.1"}, TableFormat::single, 5, 0.5, 40);
  const EnergyConservation kept = conserve_energy(brdf, {});
  ASSERT_GT(kept.largest_before[0], 1.5);
  // Albedos nearer than 75 degrees do not exceed 1. Up to 60 degrees, little light goes to directions that do.
  for (const double theta_deg : {0.0, 15.0, 30.0, 45.0, 60.0, 80.0, 85.0}) {
    const Vec3 wi = spherical_direction(radians(theta_deg), 0);
    const double before = directional_albedo(brdf, wi).albedo[0];
    EXPECT_NEAR(directional_albedo(kept.brdf, wi).albedo[0], std::min(before, 1.0), 0.02) << theta_deg;
  }
}

TEST(EnergyCost, RefusesOptionsOutOfRange) {
  const FactoredBrdf brdf = steep_model("pqp", {}, TableFormat::half, 0, 0.3);
  EXPECT_THROW(conserve_energy(brdf, {.theta_count = 1}), Error);
  EXPECT_THROW(conserve_energy(brdf, {.phi_count = 0}), Error);
  EXPECT_THROW(conserve_energy(brdf, {.tolerance = 0}), Error);
}

}  // namespace
}  // namespace burnish
