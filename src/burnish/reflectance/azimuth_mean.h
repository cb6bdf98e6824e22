// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <burnish/math/point2.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// An anisotropic source as the isotropic one that it is on average: the mean over kTurns rotations of both
/// directions about the normal, evenly over the circle. Rotations for which the source knows nothing are left
/// out; unknown where all are. Isotropic sources give their own values. Channels: at most kMaxChannels.
///
/// With `exchange`, every second rotation exchanges wi and wo: the mean over both orders for no more evaluations than
/// one takes. For isotropic sources it is SymmetrizedBrdf's.
class AzimuthMean {
 public:
  static constexpr int kTurns = 36, kMaxChannels = 1024;

  /// Refers to the source. Throws Error if it has more channels.
  explicit AzimuthMean(BrdfRef source, bool exchange = false);

  std::size_t channels() const noexcept { return source_.channels(); }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

 private:
  bool mean(BrdfRef source, Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  BrdfRef source_;
  bool exchange_;
  std::array<Point2, kTurns> turns_;  // cosine, sine
};

static_assert(HasRawValues<AzimuthMean>);

}  // namespace burnish
