// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/search.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/log_models.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

using fixtures::kHalfRgb;

// Brushed metal along x under lacquer along y, which is visible only at grazing angles.
struct Crossed {
  AnalyticBrdf one = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.5,f0=0.9,kd=0.1"),
               other = parse_analytic("ggx:alpha_x=0.5,alpha_y=0.1,f0=0.01,kd=0");

  static std::size_t channels() noexcept { return 3; }
  static bool isotropic() noexcept { return false; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    std::array<double, 3> more{};
    const bool known = one.eval(wi, wo, f) && other.eval(wi, wo, more);
    for (std::size_t c = 0; c < 3; ++c) f[c] += 20 * more[c];
    return known;
  }
};

TEST(PlanFor, GivesAnAnisotropicSourceTheLobesItHas) {
  BURNISH_SKIP_WHERE_SANITIZED();
  constexpr std::size_t kBytesOfTwo = 9000;
  const AnalyticBrdf single = parse_analytic("ggx:alpha_x=0.15,alpha_y=0.5,kd=0.1");
  const auto lobes = [&](BrdfRef source, int wanted) {
    const TrainingSet set = draw_training_set(source, {.pictures = 12'000, .directions = 36'000});
    double progress = -1;
    RefineOptions options;
    options.progress = [&](double f) {
      EXPECT_GE(f, progress);
      EXPECT_LE(f, 1);
      progress = f;
    };
    return plan_for(source, set, kBytesOfTwo, wanted, kHalfRgb, options).lobes;
  };
  EXPECT_EQ(lobes(single, 0), 1);
  EXPECT_GT(lobes(Crossed{}, 0), 1);
  EXPECT_EQ(lobes(Crossed{}, 2), 1);
}

TEST(Search, ImprovesAPlanThatMissesAFactorAndRepeatsItself) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2,kd=0.2,f0=0.3");
  const int share = BURNISH_SANITIZED ? 4 : 1;  // sanitizers are slow
  const TrainingSet set =
      draw_training_set(ggx.ref(), {.pictures = 2000 / share, .directions = 4000 / share});
  LobePlan start{.lobes = 1,
                 .factors = {{"q", TableShape::line, {kProjectHalf}, 1, {}},
                             {"r", TableShape::line, {kProjectDifference}, 1, {}}}};
  double progress = -1;
  const SearchOptions options{.bytes = 500, .texel_bytes = kHalfRgb, .progress = [&](double f) {
                                EXPECT_GE(f, 0);
                                EXPECT_LE(f, 1);
                                progress = f;
                              }};
  const SearchResult a = search_plan(set, start, options), b = search_plan(set, start, options);
  EXPECT_EQ(a.plan, b.plan);
  EXPECT_NE(a.plan, start);
  EXPECT_EQ(progress, 1);
  EXPECT_EQ(a.trials.front().change, "start");
  double best = a.trials.front().objective;
  for (const SearchTrial& t : a.trials)
    if (t.kept) best = std::min(best, t.objective);
  EXPECT_LT(best, a.trials.front().objective);
}

}  // namespace
}  // namespace burnish
