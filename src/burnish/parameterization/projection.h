// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <burnish/math/vec3.h>

namespace burnish {

/// A projection pi(wi, wo) of the paper's eq. 4: a unit vector of the upper hemisphere made from the two
/// directions.
/// - affine: normalize(wi * WI + wo * WO + mirror * mirror(WI) + n * N), a normalized affine combination of
///   the light, the view, the mirrored light (-x, -y, z) and the normal; wi, wo and h are the simplest of
///   them;
/// - difference: the light direction in the frame of the half vector, theta_d from its z, phi_d from its
///   azimuth [Rusinkiewicz 1998];
/// - deviation: a polar angle alone (azimuth 0), theta_m: half the angle between the view and the light's
///   mirror direction, 0 in the middle of a highlight; the same when the directions are exchanged;
/// - twist: a polar angle alone, theta_t, the one polar angle that tells a pair from its mirror image: to
///   which side of the plane of h and n the directions turn off. tan(theta_t / 2) = 1/2 + (3 sqrt(3) / 4) x,
///   x = sin^2 theta_d cos theta_d sin(2 phi_d) sin^2 theta_h / (sin^2 theta_h + 1/256), is between 0 and 1
///   and becomes 1 less itself in the mirror; the same when the directions are exchanged;
/// - azimuth: a polar angle alone, phi_d folded into [0, pi/2]: |cos phi_d| = |cos theta_i - cos theta_o| /
///   (2 sin theta_h sin theta_d), 0 where the plane of the directions holds the normal, pi/2 where both are
///   equally steep; the same when the directions are exchanged and in the mirror. Where phi_d has no meaning,
///   sin theta_h sin theta_d = 0, it is 0;
/// - side: a polar angle alone, phi_s, phi_d modulo pi: tan(phi_s / 2) = (1 + s tan(phi / 2)) / 2, phi the folded phi_d
///   and s = 1 or -1 the sign of sin(2 phi_d), 1 where that is 0. It becomes 1 less itself in the mirror but where
///   phi_d = pi/2: there a circle is cut, and 0 and 1 are one place. The same when the directions are exchanged.
struct Projection {
  enum class Kind { affine, difference, deviation, twist, azimuth, side };

  Kind kind = Kind::affine;
  double wi = 0, wo = 0, mirror = 0, n = 0;

  friend bool operator==(const Projection&, const Projection&) = default;
};

inline constexpr Projection kProjectWi{.wi = 1};
inline constexpr Projection kProjectWo{.wo = 1};
inline constexpr Projection kProjectHalf{.wi = 1, .wo = 1};
inline constexpr Projection kProjectDifference{.kind = Projection::Kind::difference};
inline constexpr Projection kProjectDeviation{.kind = Projection::Kind::deviation};
inline constexpr Projection kProjectTwist{.kind = Projection::Kind::twist};
inline constexpr Projection kProjectAzimuth{.kind = Projection::Kind::azimuth};
inline constexpr Projection kProjectSide{.kind = Projection::Kind::side};

/// The projections that have a number in `.burnish` files: their places here. New ones go to the end.
inline constexpr std::array kNumberedProjections{kProjectWi,         kProjectWo,        kProjectHalf,
                                                 kProjectDifference, kProjectDeviation, kProjectTwist,
                                                 kProjectAzimuth,    kProjectSide};

/// Twist, unnormalized: S = wi + wo and A = wi - wo, tan(theta_t / 2) = r / den with
/// den = 2 (S.x^2 + S.y^2 + |S|^2 kTwistCore), r = den / 2 + A.z (S.y A.x - S.x A.y) |S|^2 kTwistScale;
/// of opposite directions 1/2.
inline constexpr double kTwistCore = 1.0 / 256, kTwistScale = 0.6495190528383290;  // 3 sqrt(3) / 8

/// Returns true if a projection has a polar angle but no azimuth.
constexpr bool is_angle_alone(const Projection& p) noexcept {
  return p.kind != Projection::Kind::affine && p.kind != Projection::Kind::difference;
}

/// The projected direction, z >= 0 (a combination that points below the horizon is clamped to it). wi and wo
/// above the horizon. Exactly equal for (wi, wo) and (wo, wi) under swapped(projection).
Vec3 project(const Projection& projection, Vec3 wi, Vec3 wo) noexcept;

/// tan(theta / 2) of project(projection, wi, wo), cheaper where the azimuth is not needed.
double project_tan_half(const Projection& projection, Vec3 wi, Vec3 wo) noexcept;

/// The projection that gives for (wo, wi) what `projection` gives for (wi, wo), as far as a table sees it:
/// `azimuth` says whether the table depends on the azimuth. Nothing where there is none (mirror terms).
std::optional<Projection> swapped(const Projection& projection, bool azimuth) noexcept;

/// A projection as text names it.
struct NamedProjection {
  Projection projection;
  bool angle_only = false;  ///< by the name of an angle, which stands for the same vector
};

/// Reads wi, wo, h, d, theta_h, theta_d, theta_m, theta_t, phi_d, phi_s, theta_i, theta_o or a sum of terms such as
/// "wi+wo+0.5n", "m+0.8wo" (m is the mirrored light). Throws Error on anything else.
NamedProjection parse_projection(std::string_view text);
/// "affine", "difference", "deviation", "twist", "azimuth" or "side".
std::string_view to_string(Projection::Kind kind) noexcept;
/// A text parse_projection reads back to the same projection.
std::string to_string(const Projection& projection);

}  // namespace burnish
