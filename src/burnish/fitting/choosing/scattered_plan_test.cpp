// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/factors/byte_count.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/scattered_forms.h>
#include <burnish/fitting/choosing/scattered_plan.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/sample_source.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;

// A measured highlight in several channels, of which the first is the darkest.
Source scattered(std::size_t channels, const char* brdf = "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5,kd=0.2",
                 std::size_t count = 60) {
  const Samples grey = measure(parse_analytic(brdf), {.count = count, .noise = 0.1, .seed = 3});
  Samples samples{.channels = channels, .isotropic = grey.isotropic, .pairs = grey.pairs, .values = {}};
  for (std::size_t i = 0; i < grey.size(); ++i)
    for (std::size_t c = 0; c < channels; ++c) samples.values.push_back(grey.at(i)[0] * (c + 1) / channels);
  return {"scattered", ScatteredBrdf(std::move(samples)), {}};
}

std::size_t least(const Source& source, TableFormat format) {
  return least_scattered_bytes(source.ref().channels(), source.ref().isotropic(), format);
}

TEST(ScatteredPlan, KeepsEveryBudget) {
  for (const std::size_t channels : {3, 1, 31}) {
    if (BURNISH_SANITIZED && channels != 3) continue;
    const Source source = scattered(channels);
    for (const auto& format :
         {std::optional<TableFormat>(), std::optional(TableFormat::half), std::optional(TableFormat::single),
          std::optional(TableFormat::unorm8), std::optional(TableFormat::rgb9e5)}) {
      if (format == TableFormat::rgb9e5 && channels != 3) continue;
      for (const std::size_t bytes : {592, 2700, 64 << 10}) {
        FitOptions options{.form = Budget{.bytes = bytes, .lobes = 3, .scattered = {.reweightings = 0}},
                           .smooth = 1e-5,
                           .format = format};
        if (bytes < least(source, format.value_or(TableFormat::half))) continue;
        const Fit made = fit(source, options);
        EXPECT_LE(made.bytes(), bytes) << channels;
        // With few samples, fine models predict no better.
        EXPECT_GE(made.bytes(), std::min<std::size_t>(bytes / 2, 140 * channels))
            << channels << " channels, " << bytes << " bytes";
      }
    }
  }
}

TEST(ScatteredPlan, SaysTheLeastBudget) {
  for (const char* brdf :
       {"ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5,kd=0.2", "ggx:alpha_x=0.2,alpha_y=0.5,f0=0.5,kd=0.2"})
    for (const std::size_t channels : {1, 31}) {
      const Source source = scattered(channels, brdf);
      const std::size_t bytes = least(source, TableFormat::half);
      EXPECT_EQ(fit(source, {.form = Budget{.bytes = bytes}, .target = FitTarget::function, .smooth = 1e-5})
                    .bytes(),
                bytes);
      EXPECT_THAT(
          error_of([&] { fit(source, {.form = Budget{.bytes = bytes - 1}, .target = FitTarget::function}); }),
          ::testing::HasSubstr(fmt::format("at least {} bytes", bytes)));
    }
}

TEST(ScatteredPlan, CountsTheBytesOfItsModels) {
  for (const char* model : {"pqpr", "p(wo) q(h) p(wi) g(theta_h,theta_d)", "q(wi+wo+0.5n)"})
    for (const TableFormat format : {TableFormat::half, TableFormat::rgb9e5}) {
      const ModelSpec spec = parse_model_spec(model, {}, true);
      const Source source = scattered(3);
      const FactoredBrdf brdf =
          fit_homomorphic(from_samples(*source.samples(), true), spec, {.format = format}).brdf;
      EXPECT_EQ(model_bytes(spec, 3, format), brdf.bytes()) << model;
    }
}

TEST(ScatteredPlan, ChoosesASmoothnessThatPredicts) {
  const Source source = scattered(1, "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5,kd=0.2", 600);
  const auto error = [&](std::optional<double> smooth) {
    const SampleSource samples = from_samples(*source.samples(), false);
    return plan_scattered(samples, 1350, smooth, {}, {.reweightings = 1}).error.value();
  };
  const double chosen = error({});
  EXPECT_LT(chosen, error(1e-10));
  EXPECT_LT(chosen, error(1));
  EXPECT_LT(chosen, 0.2);  // the noise alone gives .1 sqrt(2 / pi)
}

TEST(ScatteredPlan, DoesNotDependOnTheNumberOfThreads) {
  const Source source = scattered(4);
  const std::uint64_t bytes = BURNISH_SANITIZED ? 700 : 2700;
  const FitOptions options{.form = Budget{.bytes = bytes, .scattered = {.reweightings = 1}}};
  const Fit all = fit(source, options);
  const ThreadLimit one(1);
  EXPECT_EQ(fit(source, options).model(), all.model());
}

/// A matt surface with a lobe about wi = wo, or about the mirror direction.
struct PeakedBrdf {
  bool back = true;
  double width = 0.03;  ///< the lobe's width, radians
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const double apart = angle_between(back ? wi : mirror(wi), wo);
    f[0] = 0.1 + 20 * std::exp(-apart * apart / (2 * width * width)) * wi.z;
    return true;
  }
};

constexpr double kIncidences_deg[] = {15, 30, 60};

// Scans of three incidences, dense around the lobe, as instruments take them: rings one degree apart and then four,
// or finer.
Samples scanned(const PeakedBrdf& brdf, int fineness = 1) {
  Samples samples{1, true, {}, {}};
  for (const double theta_deg : kIncidences_deg) {
    const Vec3 wi = spherical_direction(radians(theta_deg), 0), centre = brdf.back ? wi : mirror(wi);
    const int turns = 16 * fineness;
    for (int ring = 0; ring < 40 * fineness; ++ring)
      for (int k = 0; k < (ring == 0 ? 1 : turns); ++k) {
        const double steps = static_cast<double>(ring) / fineness,
                     angle = radians(steps < 12 ? steps : 12 + 4 * (steps - 12)),
                     turn = kTwoPi * (k + 0.5 * (ring % 2)) / turns;
        const Vec3 side = normalize(cross(centre, {0, 1, 0})), up = cross(side, centre);
        const Vec3 wo =
            std::cos(angle) * centre + std::sin(angle) * (std::cos(turn) * side + std::sin(turn) * up);
        if (wo.z < 0.05) continue;
        samples.pairs.push_back({wi, wo});
        samples.values.push_back(0);
        brdf.eval(wi, wo, {&samples.values.back(), 1});
      }
  }
  return samples;
}

TEST(ScatteredPlan, TellsALobeAboutTheLightFromAHighlight) {
  const Samples back = scanned({true}), forth = scanned({false});
  EXPECT_TRUE(backscatters(from_samples(back, false)));
  EXPECT_FALSE(backscatters(from_samples(forth, false)));
}

// Samples on the whole hemisphere at each incidence, `step_deg` degrees apart.
Samples gridded(BrdfRef brdf, int step_deg) {
  Samples samples{1, true, {}, {}};
  std::vector<double> f(brdf.channels());
  for (const double theta_i_deg : kIncidences_deg)
    for (int theta_deg = 0; theta_deg < 85; theta_deg += step_deg)
      for (int phi_deg = 0; phi_deg < 360; phi_deg += step_deg) {
        samples.pairs.push_back({spherical_direction(radians(theta_i_deg), 0),
                                 spherical_direction(radians(theta_deg), radians(phi_deg))});
        brdf.eval(samples.pairs.back().wi, samples.pairs.back().wo, f);
        samples.values.push_back(f[0]);
      }
  return samples;
}

TEST(ScatteredPlan, TellsWideLobesFromCoarseScans) {
  const AnalyticBrdf rough = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5,kd=0.05");
  for (const int step_deg : {2, 4, 6}) {
    const auto found = [&](BrdfRef brdf) {
      const Samples samples = gridded(brdf, step_deg);
      return backscatters(from_samples(samples, false));
    };
    const PeakedBrdf back{true, 0.1}, forth{false, 0.1};
    EXPECT_TRUE(found(back)) << step_deg;
    EXPECT_FALSE(found(forth)) << step_deg;
    EXPECT_FALSE(found(rough.ref())) << step_deg;
  }
}

/// Rows of a lattice, as a goniometer takes them: lights every 10 degrees and viewers between them. Every other
/// viewer reads too high and the rest too low.
Samples lattice(double misread) {
  const AnalyticBrdf gloss = parse_analytic("ggx:alpha_x=0.4,alpha_y=0.4,f0=0.5,kd=0.3");
  Samples samples{1, true, {}, {}};
  std::vector<double> f(gloss.channels());
  for (int light = 1; light < 8; ++light)
    for (int viewer = 0; viewer < 8; ++viewer)
      for (int side = 0; side < 12; ++side) {
        samples.pairs.push_back({spherical_direction(radians(10.0 * light), 0),
                                 spherical_direction(radians(10.0 * viewer + 5), kPi * side / 11)});
        gloss.eval(samples.pairs.back().wi, samples.pairs.back().wo, f);
        samples.values.push_back(f[0] * (1 + misread * (viewer % 2 ? 1 : -1)));
      }
  return samples;
}

TEST(ScatteredPlan, TellsTheAnglesOfALatticeApartWhereBytesHoldIt) {
  const auto width_of_p = [](double misread, std::size_t bytes) {
    const Samples samples = lattice(misread);
    return plan_scattered(from_samples(samples, false), bytes, {}, {}, {}).spec.tables.front().layout.width;
  };
  EXPECT_GE(width_of_p(0.3, 2700), 64);
  EXPECT_LT(width_of_p(0.3, 400), 64);
}

TEST(ScatteredPlan, KeepsWithinFetches) {
  const Samples samples = scanned(PeakedBrdf{true});
  HomomorphicOptions options;
  options.backscatter = kBackscatterReach;
  for (const int fetches : {1, 2, 3, 4, 5, 6})
    EXPECT_LE(
        fetch_count(plan_scattered(from_samples(samples, false), 16384, 1e-6, {}, options, fetches).spec),
        static_cast<std::size_t>(fetches));
}

FactoredBrdf planned(const Samples& samples, std::optional<double> smooth, int reweightings,
                     std::size_t bytes = 16384) {
  const SampleSource source = from_samples(samples, false);
  HomomorphicOptions options;
  options.reweightings = reweightings;
  options.backscatter = kBackscatterReach;
  const ScatteredPlan plan = plan_scattered(source, bytes, smooth, {}, options);
  options.smooth = plan.smooth;
  return fit_homomorphic(source, plan.spec, options).brdf;
}

// Returns the ratio of the model to the truth at wi = wo, at each incidence. wi lies at the azimuth `from`, and wo
// next to it in the direction `side`.
std::vector<double> heights_of_peak(const FactoredBrdf& model, BrdfRef brdf, double side = 0,
                                    double from = 0) {
  constexpr double kApart = 1e-9;
  std::vector<double> heights;
  for (const double theta_deg : kIncidences_deg) {
    const Vec3 w = spherical_direction(radians(theta_deg), from);
    const Vec3 across = spherical_direction(kPi / 2, from + kPi / 2);
    const Vec3 beside = normalize(w + kApart * (std::cos(side) * cross(across, w) + std::sin(side) * across));
    double expected, found;
    brdf.eval(w, w, {&expected, 1});
    model.eval(w, beside, {&found, 1});
    heights.push_back(found / expected);
  }
  return heights;
}

TEST(ScatteredPlan, HoldsThePeakAboutTheLight) {
  const PeakedBrdf brdf;
  EXPECT_THAT(heights_of_peak(planned(scanned(brdf), 1e-7, 2), brdf), Each(DoubleNear(1, 0.05)));
}

// Each incidence has one sample at the peak and none within five degrees. Only that sample tells how the peak looks
// from every side.
TEST(ScatteredPlan, HoldsThePeakOfACoarseScanFromEverySide) {
  const PeakedBrdf brdf;
  const FactoredBrdf model = planned(gridded(brdf, 5), 1e-6, 2);
  for (const double side : {0.0, kPi / 4, kPi / 2, kPi})
    EXPECT_THAT(heights_of_peak(model, brdf, side), Each(DoubleNear(1, 0.05))) << side;
}

/// The same lobe, but higher if the half vector is along x.
struct GrainedBrdf {
  PeakedBrdf even;
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return false; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    even.eval(wi, wo, f);
    const Vec3 h = half_vector(wi, wo);
    f[0] *= 1 + 0.8 * (h.x * h.x - h.y * h.y);
    return true;
  }
};

TEST(ScatteredPlan, HoldsThePeakOfAGrain) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const GrainedBrdf brdf;
  constexpr double kAzimuths[] = {0, kPi / 4, kPi / 2};
  Samples samples{1, false, {}, {}};
  for (const double azimuth : kAzimuths) {
    const auto turned = [&](Vec3 w) {
      const double c = std::cos(azimuth), s = std::sin(azimuth);
      return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z};
    };
    for (const auto& [wi, wo] : scanned(brdf.even).pairs) {
      samples.pairs.push_back({turned(wi), turned(wo)});
      samples.values.push_back(0);
      brdf.eval(samples.pairs.back().wi, samples.pairs.back().wo, {&samples.values.back(), 1});
    }
  }
  EXPECT_TRUE(backscatters(from_samples(samples, false)));
  const FactoredBrdf model = planned(samples, 1e-7, 2);
  for (const double azimuth : kAzimuths)
    EXPECT_THAT(heights_of_peak(model, brdf, 0, azimuth), Each(DoubleNear(1, 0.05))) << azimuth;
}

TEST(ScatteredPlan, HoldsThePeakOfManySamplesToo) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const PeakedBrdf brdf;
  const Samples samples = scanned(brdf, 5);
  ASSERT_GT(samples.size(), kManySamples);
  EXPECT_THAT(heights_of_peak(planned(samples, {}, 0, 4096), brdf), Each(DoubleNear(1, 0.03)));
}

// The lobe is found from rings a degree apart, and holds on them and between them. Without a lobe about wi = wo a
// constant predicts these rings best.
TEST(ScatteredPlan, FindsALobeAsNarrowAsTheRings) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const PeakedBrdf brdf{true, radians(1)};
  const FactoredBrdf model = planned(scanned(brdf), {}, 2);
  EXPECT_THAT(heights_of_peak(model, brdf), Each(DoubleNear(1, 0.05)));
  for (const double theta_deg : kIncidences_deg)
    for (const double beside_deg : {0.2, 0.4, 0.6, 0.8}) {
      const Vec3 wi = spherical_direction(radians(theta_deg), 0),
                 wo = spherical_direction(radians(theta_deg + beside_deg), 0);
      double highest, expected, found;
      brdf.eval(wi, wi, {&highest, 1});
      brdf.eval(wi, wo, {&expected, 1});
      model.eval(wi, wo, {&found, 1});
      EXPECT_NEAR(found, expected, 0.2 * highest) << theta_deg << ' ' << beside_deg;
      EXPECT_LT(found, 1.05 * highest) << theta_deg << ' ' << beside_deg;
    }
}

}  // namespace
}  // namespace burnish
