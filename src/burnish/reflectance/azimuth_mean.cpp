#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/azimuth_mean.h>

namespace burnish {

namespace {

Vec3 turned(Vec3 w, double cosine, double sine) noexcept {
  return {cosine * w.x - sine * w.y, sine * w.x + cosine * w.y, w.z};
}

}  // namespace

AzimuthMean::AzimuthMean(BrdfRef source) : source_(source) {
  if (source.channels() > kMaxChannels) throw Error("a source to average has at most 1024 channels");
}

bool AzimuthMean::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (source_.isotropic()) return source_.eval(wi, wo, f);
  std::array<double, kMaxChannels> buffer;
  const std::span<double> one(buffer.data(), f.size());
  std::fill(f.begin(), f.end(), 0.0);
  int known = 0;
  for (int k = 0; k < kTurns; ++k) {
    const double angle = kTwoPi * k / kTurns, c = std::cos(angle), s = std::sin(angle);
    if (!source_.eval(turned(wi, c, s), turned(wo, c, s), one)) continue;
    ++known;
    for (std::size_t i = 0; i < f.size(); ++i) f[i] += one[i];
  }
  if (known == 0) return false;
  for (double& value : f) value /= known;
  return true;
}

}  // namespace burnish
