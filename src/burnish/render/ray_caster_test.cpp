// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/math/random.h>
#include <burnish/render/ray_caster.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

// Distance along the ray, by Cramer's rule.
std::optional<double> distance_to(const Mesh& mesh, std::size_t triangle, Vec3 origin, Vec3 direction) {
  const auto at = [&](std::size_t k) { return to_vec3(mesh.vertices[mesh.triangles[triangle][k]].position); };
  const Vec3 a = at(0), e = at(1) - a, f = at(2) - a, p = cross(direction, f);
  const double det = dot(e, p);
  const Vec3 s = origin - a, q = cross(s, e);
  const double u = dot(s, p) / det, v = dot(direction, q) / det, t = dot(f, q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0)) return {};
  return t;
}

std::vector<MeshPart> random_triangles() {
  Pcg32 random(4);
  std::vector<MeshPart> parts(3);
  for (MeshPart& part : parts)
    for (std::uint32_t i = 0; i < 10; ++i) {
      const Vec3 middle = random_direction(random);
      for (int k = 0; k < 3; ++k)
        part.mesh.vertices.push_back({.position = to_floats(middle + 0.4 * random_direction(random))});
      part.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
  return parts;
}

TEST(RayCaster, FindsTheNearestOfAllTriangles) {
  const std::vector<MeshPart> parts = random_triangles();
  const RayCaster caster(parts);
  Pcg32 random(5);
  int hits = 0, disagreements = 0;
  constexpr int kRays = 3000;
  for (int i = 0; i < kRays; ++i) {
    const Vec3 origin = 3 * random_direction(random);
    const Vec3 direction = normalize(random_direction(random) - origin);
    std::optional<double> nearest;
    for (const MeshPart& part : parts)
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
        if (const auto d = distance_to(part.mesh, t, origin, direction); d && (!nearest || *d < *nearest))
          nearest = d;
    const auto found = caster.nearest(origin, direction);
    if (found.has_value() != nearest.has_value()) {
      ++disagreements;  // within rounding of an edge
      continue;
    }
    if (!found) continue;
    ++hits;
    const auto told = distance_to(parts[found->part].mesh, found->triangle, origin, direction);
    if (!told || std::abs(*told - *nearest) > 1e-4) ++disagreements;
  }
  EXPECT_GT(hits, kRays / 5);
  EXPECT_LE(disagreements, kRays / 500);
}

TEST(RayCaster, SeesWhatStandsBetweenTwoPoints) {
  std::vector<MeshPart> parts(1);
  parts[0].mesh.vertices = {{.position = {-1, -1, 0}}, {.position = {3, -1, 0}}, {.position = {-1, 3, 0}}};
  parts[0].mesh.triangles = {{0, 1, 2}};
  const RayCaster caster(parts);
  EXPECT_TRUE(caster.blocked({0, 0, 1}, {0, 0, -1}));
  EXPECT_FALSE(caster.blocked({0, 0, 1}, {0, 0, 0.5}));
  EXPECT_FALSE(caster.blocked({0, 0, 1}, {0, 0, 0})) << "a point on the surface does not hide itself";
  EXPECT_FALSE(caster.blocked({4, 4, 1}, {4, 4, -1}));
}

}  // namespace
}  // namespace burnish
