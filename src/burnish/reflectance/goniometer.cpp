#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

std::vector<DirectionPair> draw_pairs(std::size_t count, std::uint64_t seed, bool isotropic) {
  std::vector<DirectionPair> pairs;
  pairs.reserve(count);
  Pcg32 random(seed);
  while (pairs.size() < count) {
    HalfDiff angles;
    angles.theta_h = kHalfPi * random.uniform();
    angles.theta_d = kHalfPi * random.uniform();
    angles.phi_d = kTwoPi * random.uniform();
    angles.phi_h = isotropic ? 0 : kTwoPi * random.uniform();
    const auto [wi, wo] = from_half_diff(angles);
    if (wi.z > kDrawnCosine && wo.z > kDrawnCosine) pairs.push_back({wi, wo});
  }
  return pairs;
}

}  // namespace burnish
