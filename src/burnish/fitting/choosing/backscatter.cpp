#include <optional>
#include <vector>

#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

namespace {

constexpr double kMinHeight = 1.5;
constexpr double kTilts_deg[] = {20, 30, 40, 50, 60};
constexpr double kNear_deg[] = {0.25, 0.75}, kRing_deg[] = {10, 12, 14};
constexpr int kAzimuths = 8;

/// The mean over channels and azimuths at some theta_d; nothing where a value is not known.
template <class Angles>
std::optional<double> mean_at(BrdfRef source, double theta_h, const Angles& theta_d_deg) {
  std::vector<double> f(source.channels());
  double sum = 0;
  for (const double angle_deg : theta_d_deg)
    for (int i = 0; i < kAzimuths; ++i) {
      const auto [wi, wo] = from_half_diff({theta_h, 0, radians(angle_deg), kTwoPi * (i + 0.5) / kAzimuths});
      if (!source.eval(wi, wo, f)) return {};
      for (const double value : f) sum += value;
    }
  return sum / (static_cast<double>(std::size(theta_d_deg) * f.size()) * kAzimuths);
}

}  // namespace

bool backscatters(BrdfRef source) {
  if (!source.isotropic()) return false;
  int known = 0, higher = 0;
  for (const double tilt_deg : kTilts_deg) {
    const auto near = mean_at(source, radians(tilt_deg), kNear_deg),
               ring = mean_at(source, radians(tilt_deg), kRing_deg);
    if (!near || !ring) continue;
    ++known;
    higher += *near > kMinHeight * *ring;
  }
  return 2 * higher > known;
}

}  // namespace burnish
