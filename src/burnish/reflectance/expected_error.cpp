// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/expected_error.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

namespace {

constexpr std::size_t kExpectedPairs = 2000, kExpectedTogether = 64;
constexpr std::uint64_t kExpectedSeed = 23;

/// The mean of |x|, x normal.
double mean_size(double mean, double sigma) noexcept {
  mean = std::abs(mean);
  if (!(sigma > 0)) return mean;
  const double z = mean / sigma;
  return sigma * std::sqrt(2 / kPi) * std::exp(-0.5 * z * z) + mean * std::erf(z / std::numbers::sqrt2);
}

}  // namespace

ExpectedError expected_error(const KrigedNodes& function, BrdfRef model) {
  const std::size_t of_function = function.channels(), of_model = model.channels();
  if (of_model != of_function && of_model != 1 && of_function != 1)
    throw Error(
        fmt::format("expected error: expected a model of {} or 1 channels, found {}", of_function, of_model));
  const std::size_t channels = std::max(of_function, of_model);
  const std::vector<DirectionPair> pairs = draw_pairs(kExpectedPairs, kExpectedSeed, function.isotropic());
  std::vector<double> errors(pairs.size(), -1);
  for_each_chunk(pairs.size(), kExpectedTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<double> f(of_function), g(of_model);
    for (std::size_t i = begin; i < end; ++i) {
      const auto [wi, wo] = pairs[i];
      if (!(std::min(wi.z, wo.z) > NodeScoring{}.least_cosine) || !model.eval(wi, wo, g)) continue;
      function.eval(wi, wo, f);
      const double sigma = function.uncertainty(wi, wo).function;
      double sum = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        // One channel serves for each of the other side's.
        const double own = f[of_function == 1 ? 0 : c], its = std::max(0.0, g[of_model == 1 ? 0 : c]);
        sum += mean_size(std::log((own + KrigedNodes::kFloor) / (its + KrigedNodes::kFloor)), sigma);
      }
      errors[i] = sum / static_cast<double>(channels);
    }
  });

  // Means over all pairs and over those of each band.
  ExpectedError expected;
  std::array<double, std::tuple_size_v<decltype(expected.by_theta_i)>> sums{}, counts{};
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (errors[i] < 0) continue;
    const auto band = static_cast<std::size_t>(degrees(theta_of(pairs[i].wi)) / ExpectedError::kBandDegrees);
    sums[std::min(band, sums.size() - 1)] += errors[i];
    counts[std::min(band, sums.size() - 1)] += 1;
    sum += errors[i];
    count += 1;
  }
  if (count > 0) expected.relative = std::expm1(sum / count);
  for (std::size_t band = 0; band < sums.size(); ++band)
    if (counts[band] > 0) expected.by_theta_i[band] = std::expm1(sums[band] / counts[band]);
  return expected;
}

}  // namespace burnish
