// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/lighting/transformed_cosine.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

// Returns z of the integral over an edge between unit vectors: their angle times the unit normal of their plane.
double edge_integral(Vec3 a, Vec3 b) noexcept {
  const Vec3 normal = cross(a, b);
  const double sine = length(normal);
  return sine < 1e-300 ? 0 : normal.z * std::atan2(sine, dot(a, b)) / sine;
}

}  // namespace

double TransformedCosine::determinant() const noexcept {
  const auto& b = inverse;
  return b[0] * (b[4] * b[8] - b[5] * b[7]) - b[1] * (b[3] * b[8] - b[5] * b[6]) +
         b[2] * (b[3] * b[7] - b[4] * b[6]);
}

double TransformedCosine::density(Vec3 w) const noexcept {
  const Vec3 c = to_cosine(w);
  if (c.z <= 0) return 0;
  // The cosine's density is multiplied by the change of solid angle, |det| / |c|^3 [Heitz2016, eq. 1].
  const double square = dot(c, c);
  return c.z / kPi * std::abs(determinant()) / (square * square);
}

double TransformedCosine::share_above() const noexcept {
  // The upper hemisphere becomes one about `up`; the cosine's share of it is (1 + cos) / 2.
  const auto& b = inverse;
  const double sign = determinant() < 0 ? -1 : 1;
  const Vec3 up =
      sign * Vec3{b[3] * b[7] - b[4] * b[6], b[1] * b[6] - b[0] * b[7], b[0] * b[4] - b[1] * b[3]};
  return 0.5 * (1 + up.z / length(up));
}

std::vector<Vec3> clipped_above(std::span<const Vec3> polygon) {
  std::vector<Vec3> kept;
  kept.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (a.z > 0) kept.push_back(a);
    if ((a.z > 0) != (b.z > 0)) {
      Vec3 cut = a + (a.z / (a.z - b.z)) * (b - a);
      cut.z = 0;
      kept.push_back(cut);
    }
  }
  return kept;
}

double cosine_share(std::span<const Vec3> polygon) noexcept {
  // Edges are cut at the horizon. The remaining polygon follows the horizon from the point where it leaves to the
  // point where it enters.
  double sum = 0;
  Vec3 left{}, entered{};
  bool cut = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    Vec3 a = polygon[i], b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    if (a.z <= 0 && b.z <= 0) continue;
    if ((a.z > 0) != (b.z > 0)) {
      Vec3 at = a + (a.z / (a.z - b.z)) * (b - a);
      at.z = 0;
      (a.z > 0 ? left : entered) = at;
      (a.z > 0 ? b : a) = at;
      cut = true;
    }
    sum += edge_integral(normalize(a), normalize(b));
  }
  if (cut) sum += edge_integral(normalize(left), normalize(entered));
  return std::min(std::abs(sum) / kTwoPi, 1.0);
}

double lobe_share(const TransformedCosine& lobe, std::span<const Vec3> polygon) {
  std::vector<Vec3> seen = clipped_above(polygon);
  for (Vec3& corner : seen) corner = lobe.to_cosine(corner);
  return cosine_share(seen);
}

}  // namespace burnish
