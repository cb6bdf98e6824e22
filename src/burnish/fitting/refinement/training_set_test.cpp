// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/fitting/refinement/lookups.h>
#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::random_model;
using fixtures::small_set;

TEST(TrainingSet, IsPixelsAndPairsAboveTheHorizonAndTheSameForASeed) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2");
  const TrainingSet set = small_set(ggx), again = small_set(ggx);
  EXPECT_EQ(set.pairs, again.pairs);
  EXPECT_EQ(set.picture_count, 3000u);
  EXPECT_GT(set.exposure, 0);
  double pair_weights = 0, rim_weights = 0;
  std::size_t rim = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_GT(set.pairs[i].wi.z, 0);
    EXPECT_GT(set.pairs[i].wo.z, 0);
    EXPECT_NEAR(length(set.pairs[i].wi), 1, 1e-12);
    EXPECT_GT(set.weights[i], 0);
    if (i < set.picture_count) continue;
    const double least = std::min(set.pairs[i].wi.z, set.pairs[i].wo.z);
    EXPECT_GT(least, 0.005);
    (least > 0.05 ? pair_weights : rim_weights) += set.weights[i];
    rim += least <= 0.05;
  }
  EXPECT_EQ(set.size(), 6000 + rim);         // pairs near the horizon come on top
  EXPECT_NEAR(pair_weights / 3000, 1, 0.2);  // but for the pairs that fall below the horizon
  EXPECT_GT(rim, 100u);
  EXPECT_LT(rim_weights, 0.02 * pair_weights);
  const TrainingSet part = thinned(set, 7);
  EXPECT_EQ(part.pairs.front(), set.pairs.front());
  EXPECT_EQ(part.picture_count, (3000u + 6) / 7);
  EXPECT_EQ(part.pairs[part.picture_count], set.pairs[set.picture_count]);
}

TEST(TrainingSet, CrowdsPixelsAtTheHighlightAndWeighsThemAsIfTheyWereEven) {
  const AnalyticBrdf matte = parse_analytic("ggx:alpha_x=0.4,alpha_y=0.4,kd=0.5");
  const auto near_highlight = [](const TrainingSet& set, bool weighted) {
    double near = 0, all = 0;
    for (std::size_t i = 0; i < set.picture_count; ++i) {
      const Vec3 half = normalize(set.pairs[i].wi + set.pairs[i].wo);
      const double weight = weighted ? set.weights[i] : 1;
      all += weight;
      if (half.z > std::cos(0.2)) near += weight;
    }
    return near / all;
  };
  const TrainingSet even = draw_training_set(matte, {.pictures = 40'000, .directions = 10});
  const TrainingSet crowded =
      draw_training_set(matte, {.pictures = 40'000, .directions = 10, .crowded = true});
  EXPECT_GT(near_highlight(crowded, false), 3 * near_highlight(even, false));
  EXPECT_NEAR(near_highlight(crowded, true) / near_highlight(even, true), 1, 0.05);
  for (std::size_t i = 0; i < crowded.picture_count; ++i) {
    EXPECT_GT(crowded.weights[i], 0);
    EXPECT_LE(crowded.weights[i], 2);
  }
  EXPECT_GT(crowded.exposure, even.exposure);  // pixels in the dark count
}

TEST(TrainingSet, OfNothingStaysOfNothing) {
  const TrainingSet nothing{.channels = 3, .isotropic = true};
  const ModelSpec spec = random_model("z(h) v(theta_h,theta_d,phi_d)", {"z=9", "v=5x4x3"}, 3).spec;
  EXPECT_EQ(thinned(nothing, 2).size(), 0u);
  EXPECT_EQ(ordered_by_cells(nothing, spec).size(), 0u);
}

TEST(TrainingSet, InTheOrderOfCellsHasTheSamePairs) {
  const TrainingSet set = draw_training_set(parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2").ref(), {});
  const LogModel model = random_model("z(h) v(theta_h,theta_d,phi_d)", {"z=9", "v=5x4x3"}, 3);
  const TrainingSet ordered = ordered_by_cells(set, model.spec);
  ASSERT_EQ(ordered.size(), set.size());
  EXPECT_EQ(ordered.picture_count, set.picture_count);
  EXPECT_EQ(ordered.exposure, set.exposure);
  // whatever is summed over them stays
  const auto of = [](const TrainingSet& of_set, std::size_t begin, std::size_t end) {
    std::vector<std::array<double, 5>> rows;
    for (std::size_t i = begin; i < end; ++i)
      rows.push_back({of_set.pairs[i].wi.x, of_set.pairs[i].wi.y, of_set.pairs[i].wo.x,
                      static_cast<double>(of_set.values[i * of_set.channels]),
                      static_cast<double>(of_set.weights[i])});
    std::ranges::sort(rows);
    return rows;
  };
  EXPECT_EQ(of(ordered, 0, set.picture_count), of(set, 0, set.picture_count));
  EXPECT_EQ(of(ordered, set.picture_count, set.size()), of(set, set.picture_count, set.size()));
  // and neighbours share their cell
  const Lookups lookups = lookups_of(model.spec, ordered);
  std::size_t changes = 0;
  for (std::size_t i = 1; i < set.size(); ++i) {
    const auto node = [&](std::size_t pair) {
      return lookups
          .places[(pair / Lookups::kBlock * lookups.place_count + lookups.place_of[1]) * Lookups::kBlock +
                  pair % Lookups::kBlock]
          .node;
    };
    changes += node(i) != node(i - 1);
  }
  EXPECT_LE(changes, 2 * 5u * 4 * 3);
}

}  // namespace
}  // namespace burnish
