#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/math/vec3.h>
#include <burnish/shaders/half_range.h>

namespace burnish {

namespace {

constexpr int kMostExponent = 15;
// Logarithms to base 2 that products are kept between; what is darker than 2^kDark may lose digits.
constexpr double kBright = 14, kFaint = -14, kDark = -10;

double log_scale(const Lobe& lobe) noexcept {
  const double most = std::ranges::max(lobe.scale);
  return most > 0 ? std::log2(most) : 0;
}

struct DirectionsOfRange {
  Vec3 wi, wo;
};

// Pairs all over the hemisphere, many of them near the mirror direction and near each other.
std::vector<DirectionsOfRange> directions_of_range() {
  constexpr int kCount = 3000;
  Pcg32 random(23);
  std::vector<DirectionsOfRange> pairs;
  while (pairs.size() < kCount) {
    const auto draw = [&] {
      const double z = 0.002 + 0.998 * random.uniform(), phi = kTwoPi * random.uniform();
      const double s = std::sqrt(1 - z * z);
      return Vec3{s * std::cos(phi), s * std::sin(phi), z};
    };
    const Vec3 wo = draw(), apart = draw();
    const double kind = random.uniform(), width = std::pow(10.0, -4 * random.uniform());
    const Vec3 middle = kind < 0.4 ? mirror(wo) : wo;
    const Vec3 wi = kind < 0.3 ? apart : normalize(middle + width * apart);
    if (wi.z > 0) pairs.push_back({wi, wo});
  }
  return pairs;
}

// Of a lobe's first factors, the logarithms of the largest and the smallest channel for each pair.
struct PartialLogs {
  double most, least;
};
std::vector<PartialLogs> partial_logs(const FactoredBrdf& brdf, std::span<const FactorUse> factors,
                                      std::span<const DirectionsOfRange> pairs) {
  std::vector<double> ones(static_cast<std::size_t>(brdf.channels()), 1.0), f = ones;
  const FactoredBrdf part(brdf.channels(), {brdf.tables().begin(), brdf.tables().end()},
                          {{.scale = ones, .factors = {factors.begin(), factors.end()}}});
  std::vector<PartialLogs> logs;
  for (const auto& [wi, wo] : pairs) {
    part.eval(wi, wo, f);
    logs.push_back({std::log2(std::ranges::max(f)), std::log2(std::ranges::min(f))});
  }
  return logs;
}

}  // namespace

std::vector<int> table_exponents(const FactoredBrdf& brdf) {
  const auto tables = brdf.tables();
  std::vector<double> exponents(tables.size(), 0);

  // what a lobe's scale lacks or has too much is shared by its tables, in turn [Kaczmarz 1937]
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round)
    for (const Lobe& lobe : brdf.lobes()) {
      double rest = log_scale(lobe);
      int movable = 0;
      for (const FactorUse& use : lobe.factors) {
        rest -= exponents[static_cast<std::size_t>(use.table)];
        movable += brdf.table_of(use).format != TableFormat::unorm8;
      }
      for (const FactorUse& use : lobe.factors)
        if (brdf.table_of(use).format != TableFormat::unorm8) {
          double& exponent = exponents[static_cast<std::size_t>(use.table)];
          exponent = std::clamp(exponent + rest / movable, 0.0, double{kMostExponent});
        }
    }
  std::vector<int> whole;
  for (const double exponent : exponents) whole.push_back(static_cast<int>(std::lround(exponent)));
  return whole;
}

std::vector<int> step_exponents(const FactoredBrdf& brdf, std::size_t lobe,
                                const std::vector<int>& exponents) {
  const auto factors = brdf.ordered_factors(lobe);
  const std::size_t pairs = brdf.pair_count(lobe), steps = factors.size() - pairs;
  std::vector<int> shifts(steps, 0);
  if (steps == 0) return shifts;

  // products after each step as they are
  const std::vector<DirectionsOfRange> directions = directions_of_range();
  double shift = log_scale(brdf.lobes()[lobe]);  // of the scale and the tables so far
  for (const FactorUse& use : factors) shift -= exponents[static_cast<std::size_t>(use.table)];
  const std::vector<PartialLogs> whole = partial_logs(brdf, factors, directions);
  const double scale = log_scale(brdf.lobes()[lobe]);
  std::vector<double> brightest(steps, -std::numeric_limits<double>::infinity());
  bool fits = shift <= kBright && shift >= kFaint;
  for (std::size_t step = 0, used = 0; step < steps; ++step) {
    const std::size_t next = used + (step < pairs ? 2 : 1);
    for (; used < next; ++used) shift += exponents[static_cast<std::size_t>(factors[used].table)];
    const std::vector<PartialLogs> logs = partial_logs(brdf, factors.first(used), directions);
    for (std::size_t i = 0; i < logs.size(); ++i) {
      brightest[step] = std::max(brightest[step], shift + logs[i].most);
      if (scale + whole[i].most >= kDark && scale + whole[i].most <= kBright)
        fits = fits && shift + logs[i].most <= kBright + 1 && shift + logs[i].least >= kFaint - 3;
    }
  }
  if (fits) return shifts;

  // else each as bright as it may be, and the last as it is
  int before = 0;
  for (std::size_t step = 0; step < steps; ++step) {
    const int here = step + 1 == steps ? 0 : static_cast<int>(std::floor(kBright - brightest[step]));
    shifts[step] = here - before;
    before = here;
  }
  return shifts;
}

}  // namespace burnish
