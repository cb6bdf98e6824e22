// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/azimuth_mean.h>

namespace burnish {

namespace {

Vec3 turned(Vec3 w, Point2 by) noexcept {
  return {by.x * w.x - by.y * w.y, by.y * w.x + by.x * w.y, w.z};
}

}  // namespace

AzimuthMean::AzimuthMean(BrdfRef source, bool exchange) : source_(source), exchange_(exchange) {
  if (source.channels() > kMaxChannels) throw Error("a source to average has at most 1024 channels");
  for (int k = 0; k < kTurns; ++k) {
    const double angle = kTwoPi * k / kTurns;
    turns_[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
  }
}

bool AzimuthMean::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return mean(source_, wi, wo, f);
}

bool AzimuthMean::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return mean(source_.unclamped(), wi, wo, f);
}

bool AzimuthMean::mean(BrdfRef source, Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (source.isotropic()) return exchange_ ? SymmetrizedBrdf(source).eval(wi, wo, f) : source.eval(wi, wo, f);
  // The mean is over rotations of both directions; those at which the source is unknown are left out.
  std::array<double, kMaxChannels> buffer;
  const std::span<double> one(buffer.data(), f.size());
  std::fill(f.begin(), f.end(), 0.0);
  int known = 0;
  for (std::size_t k = 0; k < kTurns; ++k) {
    const Vec3 a = turned(wi, turns_[k]), b = turned(wo, turns_[k]);
    if (!(exchange_ && k % 2 == 1 ? source.eval(b, a, one) : source.eval(a, b, one))) continue;
    ++known;
    for (std::size_t i = 0; i < f.size(); ++i) f[i] += one[i];
  }
  if (known == 0) return false;
  for (double& value : f) value /= known;
  return true;
}

}  // namespace burnish
