// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

/// Lambert times 1 + slope (cos theta_i - cos theta_o): not reciprocal.
struct Leaning {
  double slope = 0.2;

  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = wi.z > 0 && wo.z > 0 ? 0.3 * (1 + slope * (wi.z - wo.z)) : 0;
    return true;
  }
};

TEST(MeasurementQuality, IsEstimatedFromExchangedDirections) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Leaning raw;
  const SymmetrizedBrdf reference(raw);
  const Scorer scorer(reference, {.count = 5000, .image_size = 32});
  const MeasuredNodes nodes = measured_nodes(measure(raw, {.count = 500}));
  const auto quality = quality_by_exchange(scorer, raw, nodes);
  ASSERT_TRUE(quality);
  const ErrorFigures half = scorer.score(raw);
  EXPECT_NEAR(quality->figures.rms, std::sqrt(2) * half.rms, 1e-12);
  EXPECT_NEAR(quality->figures.psnr, half.psnr - 3.0103, 1e-3);
  EXPECT_EQ(quality->errors.size(), scorer.pair_errors(raw).size());
  EXPECT_FALSE(quality->repeated);
  EXPECT_FALSE(quality_by_exchange(scorer, reference, nodes));  // nothing tells
}

// A table that is reciprocal by form differs from its mean with exchanged directions by roundings.
TEST(MeasurementQuality, CannotBeToldOfRoundings) {
  const Leaning raw{.slope = 1e-13}, noisy{.slope = 1e-4};
  const SymmetrizedBrdf reference(raw), other(noisy);
  EXPECT_GT(Scorer(reference, {.count = 5000, .image_size = 32}).score(raw).rms, 0);
  EXPECT_FALSE(exchanged_figures(Scorer(reference, {.count = 5000, .image_size = 32}), raw));
  EXPECT_TRUE(exchanged_figures(Scorer(other, {.count = 5000, .image_size = 32}), noisy));
}

TEST(MeasurementQuality, IsWhatASecondScanScores) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const fixtures::Glossy first, second{.scale = 1.1};
  const Scorer scorer(first, {.count = 2000, .image_size = 32});
  MeasuredNodes nodes = measured_nodes(measure(first, {.count = 500}));
  nodes.samples.values[0] = -0.5;
  const MeasurementQuality quality = quality_by_repeat(scorer, second, nodes);
  EXPECT_TRUE(quality.repeated);
  EXPECT_EQ(quality.figures.relative, scorer.score(second).relative);
  EXPECT_NEAR(quality.negative_share, 1.0 / 1500, 1e-12);
  EXPECT_EQ(quality.negative_rms, 0.5);  // one value
}

}  // namespace
}  // namespace burnish
