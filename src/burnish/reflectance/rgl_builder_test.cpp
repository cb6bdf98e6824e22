// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

/// Trowbridge-Reitz facets with separable masking over a diffuse floor; the channels differ in tint.
struct Glossy {
  double alpha_x, alpha_y;
  int count = 3;
  bool hole = false;  // nothing known within 10 degrees of retro-reflection
  double diffuse = 1;

  std::size_t channels() const noexcept { return count; }
  bool isotropic() const noexcept { return alpha_x == alpha_y; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    std::fill(f.begin(), f.end(), 0.0);
    if (!(wi.z > 0 && wo.z > 0)) return true;
    if (hole && angle_between(wi, wo) < radians(10)) return false;
    const auto stretched = [this](Vec3 w) { return Vec3{w.x * alpha_x, w.y * alpha_y, w.z}; };
    const auto masking = [&](Vec3 w) { return 2 * w.z / (w.z + length(stretched(w))); };
    const Vec3 h = half_vector(wi, wo);
    const double slope = h.x * h.x / (alpha_x * alpha_x) + h.y * h.y / (alpha_y * alpha_y) + h.z * h.z;
    const double facets =
        masking(wi) * masking(wo) / (kPi * alpha_x * alpha_y * slope * slope * 4 * wi.z * wo.z);
    for (std::size_t c = 0; c < f.size(); ++c) {
      const double t = static_cast<double>(c) / static_cast<double>(f.size());
      f[c] = (0.9 - 0.5 * t) * facets + diffuse * (0.02 + 0.05 * t);
    }
    return true;
  }
};
static_assert(Brdf<Glossy>);

/// A small table, quick to make.
RglOptions small() {
  RglOptions options;
  options.ndf_theta = 64;
  options.ndf_phi = 32;
  options.phi_i_count = 9;
  options.theta_i_count = 12;
  return options;
}

/// Mean of |ln(a / b)| over random directions with cosines above 0.2 and over the channels.
double mean_log_error(BrdfRef source, BrdfRef table, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<double> a(source.channels()), b(a.size());
  double sum = 0;
  int count = 0;
  while (count < 2000) {
    // Uniform half vectors and differences, as the error figures draw them.
    const Vec3 h = spherical_direction(random.uniform() * kHalfPi, random.uniform() * kTwoPi);
    const Vec3 wi = random_upper_direction(random);
    const Vec3 wo = 2 * dot(wi, h) * h - wi;
    if (wi.z < 0.2 || wo.z < 0.2) continue;
    source.eval(wi, wo, a);
    table.eval(wi, wo, b);
    for (std::size_t c = 0; c < a.size(); ++c) sum += std::abs(std::log(a[c] / b[c]));
    ++count;
  }
  return sum / count / static_cast<double>(a.size());
}

void expect_exact_at_nodes(BrdfRef source, const RglTable& table) {
  const RglData& data = table.data();
  Pcg32 random(11);
  std::vector<double> a(source.channels()), b(a.size());
  const auto pick = [&](std::size_t n) {
    return static_cast<int>(random.uniform() * static_cast<double>(n));
  };
  int count = 0;
  for (int i = 0; i < 500; ++i) {
    // The ends of a part of the circle are the same direction: there either end may answer.
    const int phi = table.isotropic() ? 0 : 1 + pick(data.phi_i.size() - 2);
    const auto [wi, wo] = table.node_directions(phi, pick(data.theta_i.size() - 1),
                                                pick(static_cast<std::size_t>(data.spectra.height)),
                                                pick(static_cast<std::size_t>(data.spectra.width)));
    if (wi.z < 0.05 || wo.z < 0.05) continue;
    ++count;
    source.eval(wi, wo, a);
    table.eval(wi, wo, b);
    for (std::size_t c = 0; c < a.size(); ++c) EXPECT_NEAR(b[c] / a[c], 1, 1e-3);
  }
  EXPECT_GT(count, 200);
}

TEST(RglBuilder, IsotropicTablesReproduceTheirSource) {
  for (double alpha : {0.05, 0.2, 0.6}) {
    const Glossy source{alpha, alpha};
    const RglTable table = make_rgl_table(source, small());
    EXPECT_TRUE(table.isotropic());
    EXPECT_EQ(table.channels(), 3);
    EXPECT_LT(mean_log_error(source, table, 1), 0.02) << alpha;
    expect_exact_at_nodes(source, table);
  }
}

TEST(RglBuilder, AnisotropicTablesReproduceTheirSource) {
  const Glossy source{0.15, 0.4};
  const RglTable table = make_rgl_table(source, small());
  EXPECT_FALSE(table.isotropic());
  EXPECT_LT(mean_log_error(source, table, 2), 0.05);
  expect_exact_at_nodes(source, table);
}

TEST(RglBuilder, ReducedTablesAreAsGoodAsFullOnes) {
  const Glossy source{0.15, 0.4};
  for (int reduction : {2, 4}) {
    RglOptions options = small();
    options.reduction = reduction;
    options.phi_i_count = 8 / reduction + 1;
    const RglTable table = make_rgl_table(source, options);
    EXPECT_EQ(table.reduction(), reduction);
    EXPECT_LT(mean_log_error(source, table, 3), 0.05) << reduction;
    expect_exact_at_nodes(source, table);
  }
}

TEST(RglBuilder, MakesSpectralTables) {
  const Glossy source{0.3, 0.3, 7};
  RglOptions options = small();
  options.lambda_nm = {400, 450, 500, 550, 600, 650, 700};
  const RglTable table = make_rgl_table(source, options);
  EXPECT_EQ(table.channels(), 7);
  EXPECT_LT(mean_log_error(source, table, 4), 0.02);
}

TEST(RglBuilder, NormalDistributionIsThatOfTheFacets) {
  // Retro-reflection of facets alone gives back their distribution, here
  // D(0) = 1 / (pi alpha^2); separable masking counts once too often, hence the tolerance.
  const double alpha = 0.2;
  const RglTable table = make_rgl_table(Glossy{alpha, alpha, 3, false, 0}, small());
  EXPECT_NEAR(rgl_lookup(table.data().ndf, {0, 0.5}) * kPi * alpha * alpha, 1, 0.05);
  EXPECT_NEAR(rgl_lookup(table.data().sigma, {0, 0.5}), 1, 1e-5);
}

TEST(RglBuilder, GapsAreFilledAndMarked) {
  const Glossy source{0.3, 0.3, 1, true};
  const RglTable table = make_rgl_table(source, small());
  const RglData& data = table.data();
  const auto& valid = data.valid;
  ASSERT_EQ(valid.size() * 8, data.theta_i.size() * 32 * 32);
  EXPECT_TRUE(std::any_of(valid.begin(), valid.end(), [](auto byte) { return byte != 0xff; }));
  EXPECT_TRUE(std::any_of(valid.begin(), valid.end(), [](auto byte) { return byte == 0xff; }));
  std::vector<double> a(1), b(1);
  const Glossy whole{0.3, 0.3, 1};
  for (double theta : {0.0, 0.3, 0.8}) {
    const Vec3 w = spherical_direction(theta, 1);
    EXPECT_TRUE(table.eval(w, w, b));
    whole.eval(w, w, a);
    EXPECT_NEAR(b[0] / a[0], 1, 0.5) << theta;
  }
}

TEST(RglBuilder, BlackSourcesMakeBlackTables) {
  struct Black {
    std::size_t channels() const noexcept { return 1; }
    bool isotropic() const noexcept { return true; }
    bool eval(Vec3, Vec3, std::span<double> f) const noexcept {
      f[0] = 0;
      return true;
    }
  };
  const RglTable table = make_rgl_table(Black{}, small());
  std::vector<double> f(1, 7);
  table.eval(spherical_direction(0.5, 0), spherical_direction(0.7, 2), f);
  EXPECT_EQ(f[0], 0);
}

TEST(RglBuilder, BadOptionsThrow) {
  const Glossy source{0.3, 0.3}, brushed{0.1, 0.3};
  const auto throws = [](BrdfRef brdf, const std::function<void(RglOptions&)>& change) {
    RglOptions options = small();
    change(options);
    EXPECT_THROW(make_rgl_table(brdf, options), Error);
  };
  throws(source, [](RglOptions& o) { o.theta_i_count = 1; });
  throws(source, [](RglOptions& o) { o.ndf_theta = 1; });
  throws(source, [](RglOptions& o) { o.ndf_phi = 0; });
  throws(source, [](RglOptions& o) { o.resolution = 1; });
  throws(source, [](RglOptions& o) { o.iterations = 0; });
  throws(source, [](RglOptions& o) { o.lambda_nm = {500, 600}; });
  throws(source, [](RglOptions& o) { o.lambda_nm = {500, 600, 550}; });
  throws(brushed, [](RglOptions& o) { o.reduction = 3; });
  throws(brushed, [](RglOptions& o) { o.phi_i_count = 2; });
}

}  // namespace
}  // namespace burnish
