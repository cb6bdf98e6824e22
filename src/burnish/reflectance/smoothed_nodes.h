#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// How stiff a SmoothedNodes is: what the integrals of squared second derivatives of ln f count, over the unit
/// intervals of its axes theta_h, theta_d, phi_d and of its line of theta_h, against the mean over the nodes of the
/// error in ln f.
struct NodeSmoothness {
  std::array<double, 4> shares{1e-8, 1e-7, 1e-4, 1e-9};

  friend bool operator==(const NodeSmoothness&, const NodeSmoothness&) = default;
};

/// Places of a SmoothedNodes along theta_h, theta_d and phi_d, at least 3 each.
struct NodeVolume {
  std::size_t half = 48, difference = 24, azimuth = 8;

  std::size_t count() const noexcept { return half * difference * azimuth; }
};

/// The reciprocal function that runs smoothly between measured nodes of an isotropic surface, where interpolation
/// would follow each with its noise:
///   ln(f + 1e-3) = g(theta_h, theta_d, phi_d) + z(theta_h),
/// g linear between the places of a volume, z between 64, both in the coordinates of tables: tan(theta_h / 2) by its
/// root, tan(theta_d / 2), and tan(phi_d / 2) with phi_d folded into [0, pi/2]. Least squares, then towards the least
/// absolute error by reweighting [Daubechies 2010], which noise of dark nodes hardly moves; nodes nearer to the horizon
/// count less the nearer they are. Values lie between 0 and twice the largest node's.
class SmoothedNodes {
 public:
  static constexpr double kFloor = 1e-3;  ///< 1/sr, as in the figure `relative`

  /// Throws Error where the nodes are anisotropic or none of them has both cosines above 0.02.
  explicit SmoothedNodes(const MeasuredNodes& nodes, const NodeSmoothness& smoothness = {},
                         const NodeVolume& volume = {});

  std::size_t channels() const noexcept { return channels_; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

 private:
  std::size_t channels_ = 0;
  NodeVolume volume_;
  std::vector<double> values_;   // [unknown][channel]
  std::vector<double> largest_;  // [channel]
};

static_assert(Brdf<SmoothedNodes>);

/// `fitted` and, where no node of `all` lies near, what `function` says there, at a tenth of a node's weight:
/// instruments leave whole regions out (wide half angles, the neighbourhood of the normal), and what stands
/// there is a guess anyway. Both are isotropic and have the function's channels.
MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function);

}  // namespace burnish
