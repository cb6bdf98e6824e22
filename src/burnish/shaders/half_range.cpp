// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/math/vec3.h>
#include <burnish/shaders/half_range.h>

namespace burnish {

namespace {

constexpr int kMaxHalfExponent = 15;
// Logarithms to base 2 that products are kept between; what is darker than 2^kDark may lose digits.
constexpr double kBright = 14, kFaint = -13, kDark = -11;
constexpr double kMaxConstant = 12;

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

// Logarithms of a product of factors, of every channel of every pair.
std::vector<double> logs_of(const FactoredBrdf& brdf, std::vector<double> scale,
                            std::span<const FactorUse> factors, std::span<const DirectionsOfRange> pairs) {
  std::vector<double> f(scale.size()), logs;
  const FactoredBrdf part(brdf.channels(), {brdf.tables().begin(), brdf.tables().end()},
                          {{.scale = std::move(scale), .factors = {factors.begin(), factors.end()}}});
  for (const auto& [wi, wo] : pairs) {
    part.eval(wi, wo, f);
    for (const double value : f) logs.push_back(std::log2(value));
  }
  return logs;
}

// Returns how far products leave the range: above it where f_r is within it, below where it is not dark.
double excess(const std::vector<double>& products, const std::vector<double>& factor,
              const std::vector<double>& whole) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole[i] > kBright) continue;
    const double product = products[i] + factor[i], above = std::max(product - kBright, 0.0),
                 below = whole[i] < kDark ? 0 : std::max(kFaint - product, 0.0);
    sum += above * above + below * below;
  }
  return sum;
}

}  // namespace

std::vector<int> table_exponents(const FactoredBrdf& brdf) {
  // the middle of each table's values
  std::vector<double> exponents;
  for (const Table& table : brdf.tables())
    exponents.push_back(
        table.format == TableFormat::unorm8 ? 0 : -0.5 * std::log2(double{std::ranges::min(table.values)}));

  // what a lobe's scale lacks or has too much is shared by its tables, in turn [Kaczmarz 1937]
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round)
    for (const Lobe& lobe : brdf.lobes()) {
      double rest = log_scale(lobe);
      int movable = 0;
      for (const FactorUse& use : lobe.factors) {
        rest -= exponents[use.table];
        movable += brdf.table_of(use).format != TableFormat::unorm8;
      }
      for (const FactorUse& use : lobe.factors)
        if (brdf.table_of(use).format != TableFormat::unorm8) {
          double& exponent = exponents[use.table];
          exponent = std::clamp(exponent + rest / movable, 0.0, double{kMaxHalfExponent});
        }
    }
  std::vector<int> whole;
  for (const double exponent : exponents) whole.push_back(static_cast<int>(std::lround(exponent)));
  return whole;
}

HalfProduct half_product(const FactoredBrdf& brdf, std::size_t lobe, const std::vector<int>& exponents) {
  const auto factors = brdf.ordered_factors(lobe);
  const std::vector<double>& scale = brdf.lobes()[lobe].scale;

  // the scale as one constant that a half float holds, or several
  double rest = log_scale(brdf.lobes()[lobe]);
  for (const FactorUse& use : factors) rest -= exponents[use.table];
  const int constants = std::max(static_cast<int>(std::ceil(std::abs(rest) / kMaxConstant)), 1);
  HalfProduct product{.order = {}, .exponent = static_cast<int>(std::lround(rest / constants))};

  // what there is to multiply, and what comes out
  const std::vector<DirectionsOfRange> directions = directions_of_range();
  const std::vector<double> whole = logs_of(brdf, scale, factors, directions);
  std::vector<int> left;
  std::vector<std::vector<double>> logs;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    left.push_back(static_cast<int>(k));
    logs.push_back(logs_of(brdf, std::vector(scale.size(), 1.0), factors.subspan(k, 1), directions));
    for (double& log : logs.back()) log += exponents[factors[k].table];
  }
  for (int i = 1; i < constants; ++i) {
    left.push_back(HalfProduct::kConstant);
    logs.emplace_back(whole.size(), product.exponent);
  }

  // next always what leaves the range least
  std::vector<double> products(whole.size(), rest - (constants - 1) * product.exponent);
  while (!left.empty()) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < left.size(); ++k)
      if (const double e = excess(products, logs[k], whole); e < least) {
        least = e;
        best = k;
      }
    for (std::size_t i = 0; i < products.size(); ++i) products[i] += logs[best][i];
    product.order.push_back(left[best]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    logs.erase(logs.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return product;
}

}  // namespace burnish
