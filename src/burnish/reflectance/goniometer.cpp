// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

namespace {

DirectionPair draw_pair(Pcg32& random, bool isotropic) {
  for (;;) {
    HalfDiff angles;
    angles.theta_h = kHalfPi * random.uniform();
    angles.theta_d = kHalfPi * random.uniform();
    angles.phi_d = kTwoPi * random.uniform();
    angles.phi_h = isotropic ? 0 : kTwoPi * random.uniform();
    const auto [wi, wo] = from_half_diff(angles);
    if (wi.z > kDrawnCosine && wo.z > kDrawnCosine) return {wi, wo};
  }
}

/// Returns a standard normal number. Source: [Box 1958].
double draw_normal(Pcg32& random) {
  const double radius = std::sqrt(-2 * std::log1p(-random.uniform()));
  return radius * std::cos(kTwoPi * random.uniform());
}

}  // namespace

std::vector<DirectionPair> draw_pairs(std::size_t count, std::uint64_t seed, bool isotropic) {
  std::vector<DirectionPair> pairs(count);
  Pcg32 random(seed);
  for (DirectionPair& pair : pairs) pair = draw_pair(random, isotropic);
  return pairs;
}

Samples measure(BrdfRef source, const MeasureOptions& options) {
  if (!(options.noise >= 0) || !std::isfinite(options.noise))
    throw Error("the noise of a measurement is a finite number >= 0");
  Samples samples{source.channels(), source.isotropic(), {}, {}};
  samples.pairs.reserve(options.count);

  // Pairs and noise come from streams of their own, so noise does not change which pairs are drawn.
  std::vector<double> f(source.channels());
  Pcg32 random(options.seed), noise(options.seed, 1);
  std::size_t unknown = 0;
  while (samples.size() < options.count) {
    const DirectionPair pair = draw_pair(random, false);
    if (!source.eval(pair.wi, pair.wo, f)) {
      if (++unknown > 100 * (samples.size() + 10))
        throw Error("the source knows too few direction pairs to measure");
      continue;
    }
    samples.pairs.push_back(pair);
    for (const double value : f)
      samples.values.push_back(options.noise > 0 ? value * std::exp(options.noise * draw_normal(noise))
                                                 : value);
  }
  return samples;
}

}  // namespace burnish
