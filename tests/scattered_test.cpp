// SPDX-License-Identifier: Apache-2.0
// These tests fit real scattered samples within given budgets.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

TEST(Scattered, EveryFileKeepsItsBudgets) {
  BURNISH_SKIP_WHERE_SANITIZED();
  BURNISH_NEEDS_DATA();
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "cornell")) {
    if (entry.path().extension() != ".brdf") continue;
    ++files;
    for (const bool spectral : {false, true}) {
      const Source source = open_source(entry.path().string(), {.keep_spectral = spectral});
      for (const std::uint64_t bytes : {592, 2700, 16 << 10})
        EXPECT_LE(
            fit(source, {.form = Budget{.bytes = bytes, .scattered = {.reweightings = 0}}, .smooth = 1e-5})
                .bytes(),
            bytes)
            << entry.path();
    }
    const Source source = open_source(entry.path().string(), {});
    const Fit made = fit(source, {.form = Budget{.bytes = 2700}, .target = FitTarget::function});
    EXPECT_LE(made.bytes(), 2700u);
    EXPECT_LT(std::get<OneLobeReport>(made.report.how).relative_cross_validated.value(), 0.135)
        << entry.path();
  }
  EXPECT_GT(files, 0u);
}

// At each incidence, the sample nearest to wi = wo tests the height of the tape's peak.
TEST(Scattered, TheDefaultFitHoldsATapesPeak) {
  BURNISH_SKIP_WHERE_SANITIZED();
  BURNISH_NEEDS_DATA();
  const Source source = open_source((data_folder() / "retro" / "retro-gray-tape.dat").string(), {});
  const Fit made = fit(source, {});
  EXPECT_LE(std::get<OneLobeReport>(made.report.how).relative_cross_validated.value(), 0.10);
  const Samples& samples = *source.samples();
  for (const double theta_deg : {15.0, 30.0, 60.0}) {
    std::size_t best = samples.size();
    double least = radians(1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto& [wi, wo] = samples.pairs[i];
      if (std::abs(theta_of(wi) - radians(theta_deg)) > radians(0.5) || angle_between(wi, wo) >= least)
        continue;
      least = angle_between(wi, wo);
      best = i;
    }
    ASSERT_LT(best, samples.size()) << theta_deg;
    std::vector<double> f(samples.channels);
    made.ref().eval(samples.pairs[best].wi, samples.pairs[best].wo, f);
    EXPECT_NEAR(f[0] / samples.at(best)[0], 1, 0.05) << theta_deg;
  }

  // A fit with two fetches keeps the peak too.
  const Fit few = fit(source, {.form = Budget{.bytes = 4096, .fetches = 2}});
  EXPECT_LE(std::get<OneLobeReport>(few.report.how).relative_cross_validated.value(), 0.12);
}

}  // namespace
}  // namespace burnish
