// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <burnish/lighting/mirrored_view.h>
#include <burnish/math/angles.h>
#include <burnish/math/vec3.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A square light as a view sees it.
struct TrialLamp {
  std::array<Vec3, 5> corners{};  ///< the part above the horizon, in the frame of the mirrored view
  std::size_t count = 0;          ///< number of corners
  std::size_t size = 0;           ///< index into kTrialSizes
  double weight = 0;              ///< solid angle that this lamp represents, sr
  double cosine = 0;              ///< share of the plain cosine
  std::array<double, 3> value{};  ///< the BRDF's reflection of it at radiance 1, a channel

  std::span<const Vec3> polygon() const noexcept { return std::span(corners).first(count); }
};

/// Angles between the middles of opposite sides, radians.
inline constexpr std::array kTrialSizes{radians(3), radians(10), radians(30), radians(90)};

/// The reflections of trial lamps by a BRDF towards one view.
struct NodeTarget {
  std::size_t channels = 0;
  std::vector<TrialLamp> lamps;
  std::array<double, 3> albedo{};  ///< integral of f_r cos(theta_i), a channel
  /// The value shown as white, for each size. Lamps of 0.35 sr are brighter, about 3 % of a sphere's pixels.
  std::array<double, kTrialSizes.size()> white{};
};

/// Computes the target of one view. `halved`: only one half, for BRDFs that are their own mirror image in the plane
/// of view and normal. wo.z > 0.
NodeTarget node_target(BrdfRef brdf, Vec3 wo, AreaLightViews views, bool halved);

/// The entries of a matrix that are fitted: those that keep mirror images in the plane of view and normal, or all.
std::span<const std::size_t> free_entries(bool mirrored) noexcept;

/// The lobes of one node.
struct NodeLobes {
  std::array<double, 3> cosine{};
  struct Lobe {
    std::array<double, 9> inverse{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::array<double, 3> amplitude{};
  };
  std::vector<Lobe> lobes;
};

struct NodeFitOptions {
  bool mirrored = true;
  bool with_cosine = true;
  int iterations = 40;
  double pull = 0;  ///< weight of the distance from `near`
};

/// Minimizes the weighted squared differences of the lamps' values as they are shown (see TrialLamp), beginning at
/// `start`. Returns their sum at the end, without the pull's part. `up` are the axes of the local frame, in the frame
/// of the mirrored view. `near` may be null.
double fit_node(const NodeTarget& target, const std::array<Vec3, 3>& up, NodeLobes& start,
                const NodeLobes* near, const NodeFitOptions& options);

/// Scales all heights of every channel so that the lobes' albedo is the target's.
void conserve_albedo(const NodeTarget& target, NodeLobes& lobes, Vec3 wo, AreaLightViews views);

}  // namespace burnish
