// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/math/vec3.h>

namespace burnish {

/// Half/difference angles of two directions, radians: (theta_h, phi_h) are the polar angles of the half
/// vector h; (theta_d, phi_d) those of the difference vector d, which is wi in the frame that turns h onto
/// the normal. For directions above the horizon theta_h and theta_d lie in [0, pi/2], phi_h and phi_d in [0,
/// 2 pi). Exchanging wi and wo adds pi to phi_d and changes nothing else; an isotropic material does not
/// depend on phi_h.
struct HalfDiff {
  double theta_h = 0, phi_h = 0, theta_d = 0, phi_d = 0;
};

/// The two directions of half/difference angles.
struct HalfDiffDirections {
  Vec3 wi, wo;
};

/// Half/difference angles of two unit vectors. Where an azimuth is undefined (h is the normal, or wi is wo, to within
/// 1e-13) it is 0; opposite directions have the normal as their half vector. Source: [Rusinkiewicz 1998].
HalfDiff to_half_diff(Vec3 wi, Vec3 wo) noexcept;

/// The unit vectors with these angles, any real numbers; inverse of to_half_diff to 1e-12 in each component
/// for theta_d up to 89.9 degrees (h is ill-conditioned where the directions are opposite). The result may
/// lie below the horizon. Source: [Rusinkiewicz 1998].
HalfDiffDirections from_half_diff(const HalfDiff& angles) noexcept;

}  // namespace burnish
