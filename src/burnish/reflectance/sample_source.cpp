// SPDX-License-Identifier: Apache-2.0
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
            const auto channels = samples.channels;
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

SampleSource from_table(const HalfDiffTable& table, bool symmetrize, bool spread_phi_h) {
  struct Turn {
    double sin = 0, cos = 1;
  };
  const auto turns = [](int count, auto angle) {
    std::vector<Turn> result;
    for (int i = 0; i < count; ++i) result.push_back({std::sin(angle(i)), std::cos(angle(i))});
    return result;
  };
  // phi_h of successive entries: multiples of the golden angle
  constexpr int kSpread = 987;  // a Fibonacci number: evenly spread after one round
  constexpr double kGoldenAngle = kPi * (3 - 2.23606797749978969641);
  const bool average = symmetrize && table.full_circle && table.phi_d_count % 2 == 0;
  return {.count = table.entry_count(),
          .distinct = table.entry_count(),
          .channels = table.channel_count,
          .isotropic = true,
          .fill = [&table, average, spread_phi_h,
                   theta_h = turns(table.theta_h_count, [&](int i) { return table.centre(i, 0, 0).theta_h; }),
                   theta_d = turns(table.theta_d_count, [&](int i) { return table.centre(0, i, 0).theta_d; }),
                   phi_d = turns(table.phi_d_count, [&](int i) { return table.centre(0, 0, i).phi_d; }),
                   phi_h = turns(kSpread, [](int i) { return kGoldenAngle * i; })](
                      std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                      std::span<double> weights) {
            const auto channels = table.channel_count;
            const std::size_t n_phi = phi_d.size(), n_theta = theta_d.size();
            for (std::size_t i = 0; i < pairs.size(); ++i) {
              const std::size_t entry = begin + i, p = entry % n_phi;
              const Turn h = theta_h[entry / n_phi / n_theta], d = theta_d[entry / n_phi % n_theta],
                         f = phi_d[p];
              // the difference vector, and its mirror image about h, turned by theta_h about y
              const Vec3 v{d.sin * f.cos, d.sin * f.sin, d.cos};
              Vec3 wi{h.cos * v.x + h.sin * v.z, v.y, h.cos * v.z - h.sin * v.x};
              Vec3 wo{h.sin * v.z - h.cos * v.x, -v.y, h.cos * v.z + h.sin * v.x};
              if (spread_phi_h) {
                const Turn t = phi_h[entry % phi_h.size()];
                const auto turn = [&](Vec3 w) {
                  return Vec3{t.cos * w.x - t.sin * w.y, t.sin * w.x + t.cos * w.y, w.z};
                };
                wi = turn(wi);
                wo = turn(wo);
              }
              pairs[i] = {wi, wo};
              const float* at = table.values.data() + entry * channels;
              const float* other = average ? at + ((p + n_phi / 2) % n_phi) * channels - p * channels : at;
              const bool hole = std::isnan(at[0]) || std::isnan(other[0]);
              weights[i] = hole ? 0 : pair_weight(wi, wo);
              for (std::size_t c = 0; c < channels; ++c)
                values[i * channels + c] = hole ? 0 : 0.5 * (static_cast<double>(at[c]) + other[c]);
            }
          }};
}

}  // namespace burnish
