#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

namespace {

// Point i of the additive recurrence of the generalized golden ratio in four dimensions: phi^5 = phi + 1
// [Roberts 2018].
std::array<double, 4> recurrence_point(std::size_t i, const std::array<double, 4>& start) noexcept {
  constexpr double kRatio = 1.1673039782614187;
  std::array<double, 4> point{};
  double step = 1;
  for (std::size_t k = 0; k < point.size(); ++k) {
    step /= kRatio;
    const double x = start[k] + step * static_cast<double>(i + 1);
    point[k] = x - std::floor(x);
  }
  return point;
}

}  // namespace

SampleSource from_samples(const Samples& samples, bool symmetrize) {
  const std::size_t n = samples.size();
  return {.count = symmetrize ? 2 * n : n,
          .distinct = n,
          .channels = samples.channels,
          .isotropic = samples.isotropic,
          .fill = [&samples, n](std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                                std::span<double> weights) {
            const auto channels = static_cast<std::size_t>(samples.channels);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
              const std::size_t s = begin + i;
              const DirectionPair pair = samples.pairs[s % n];
              pairs[i] = s < n ? pair : DirectionPair{pair.wo, pair.wi};
              std::ranges::copy(samples.at(s % n),
                                values.begin() + static_cast<std::ptrdiff_t>(i * channels));
              weights[i] = 1;
            }
          }};
}

double pair_weight(Vec3 wi, Vec3 wo) noexcept {
  const Vec3 h = half_vector(wi, wo);
  return std::sqrt(h.x * h.x + h.y * h.y) * std::max(0.0, std::min(wi.z, wo.z));
}

SampleSource from_brdf(BrdfRef source, std::size_t count, std::uint64_t seed, bool spread_phi_h) {
  Pcg32 random(seed);
  const std::array<double, 4> start{random.uniform(), random.uniform(), random.uniform(), random.uniform()};
  const bool spread = spread_phi_h || !source.isotropic();
  return {.count = count,
          .distinct = count,
          .channels = source.channels(),
          .isotropic = source.isotropic(),
          .fill = [=](std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                      std::span<double> weights) {
            for (std::size_t i = 0; i < pairs.size(); ++i) {
              const std::array<double, 4> u = recurrence_point(begin + i, start);
              const auto [wi, wo] = from_half_diff({.theta_h = kHalfPi * u[0] * u[0],
                                                    .phi_h = spread ? kTwoPi * u[1] : 0.0,
                                                    .theta_d = kHalfPi * u[2],
                                                    .phi_d = kTwoPi * u[3]});
              pairs[i] = {wi, wo};
            }
            std::vector<std::uint8_t> known(pairs.size());
            source.eval(pairs, values, known);
            for (std::size_t i = 0; i < pairs.size(); ++i)
              weights[i] = known[i] ? pair_weight(pairs[i].wi, pairs[i].wo) : 0;
          }};
}

}  // namespace burnish
