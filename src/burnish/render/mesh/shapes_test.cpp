// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/render/mesh/shapes.h>

namespace burnish {
namespace {

class Shapes : public testing::TestWithParam<const char*> {
 protected:
  Shape shape() const { return parse_shape(GetParam()).value(); }
};

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::uint32_t i) { return to_vec3(mesh.vertices[i].position); };
    area += 0.5 * length(cross(at(b) - at(a), at(c) - at(a)));
  }
  return area;
}

TEST_P(Shapes, HaveOrthonormalFramesWithinTheUnitSphere) {
  for (const int count : {64, 5000}) {
    const Mesh mesh = make_shape(shape(), count);
    for (const Vertex& v : mesh.vertices) {
      EXPECT_LE(length(to_vec3(v.position)), 1 + 1e-6);
      EXPECT_NEAR(length(to_vec3(v.normal)), 1, 1e-6);
      EXPECT_NEAR(length(to_vec3(v.tangent)), 1, 1e-6);
      EXPECT_NEAR(dot(to_vec3(v.normal), to_vec3(v.tangent)), 0, 1e-6);
    }
  }
}

TEST_P(Shapes, TurnTheirTrianglesAndNormalsOutwards) {
  const Mesh mesh = make_shape(shape(), 20000);
  double worst = 1;
  for (const auto& triangle : mesh.triangles) {
    Vec3 p[3], normal;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = to_vec3(mesh.vertices[triangle[k]].position);
      normal = normal + to_vec3(mesh.vertices[triangle[k]].normal);
    }
    worst = std::min(worst, dot(normalize(normal), normalize(cross(p[1] - p[0], p[2] - p[0]))));
  }
  EXPECT_GT(worst, 0.5);
}

TEST_P(Shapes, HaveAboutAsManyVerticesAsAskedForAndAnAreaThatSettles) {
  double area = 0, before = 0;
  for (const int count : {1000, 4000, 16000, 64000}) {
    const Mesh mesh = make_shape(shape(), count);
    EXPECT_NEAR(static_cast<double>(mesh.vertices.size()) / count, 1, 0.2) << count;
    before = area;
    area = area_of(mesh);
  }
  EXPECT_NEAR(area / before, 1, 0.005);
}

INSTANTIATE_TEST_SUITE_P(All, Shapes, testing::Values("sphere", "teapot", "torus-knot", "plane"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

// Counts the edges that are not closed: each edge between two places is counted per direction, and opposite
// directions cancel.
int open_edges(const Mesh& mesh) {
  using Place = std::array<long, 3>;
  const auto place = [&](std::uint32_t i) {
    Place at;
    for (std::size_t c = 0; c < 3; ++c) at[c] = std::lround(1e5 * mesh.vertices[i].position[c]);
    return at;
  };
  std::map<std::pair<Place, Place>, int> runs;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Place a = place(t[k]), b = place(t[(k + 1) % 3]);
      if (a < b)
        ++runs[{a, b}];
      else
        --runs[{b, a}];
    }
  return static_cast<int>(std::ranges::count_if(runs, [](const auto& run) { return run.second != 0; }));
}

TEST(Shapes, SphereAndKnotAreClosed) {
  EXPECT_EQ(open_edges(make_sphere(16, 8)), 0);
  EXPECT_EQ(open_edges(make_torus_knot(60, 8)), 0);
}

TEST(Shapes, SphereHasTheAreaOfASphere) {
  EXPECT_NEAR(area_of(make_sphere(256, 128)) / (4 * 3.141592653589793), 1, 4e-4);
}

TEST(Shapes, TeapotIsSymmetricAndStandsUpright) {
  const Mesh mesh = make_teapot(6);
  Vec3 low{9, 9, 9}, high{-9, -9, -9};
  for (const Vertex& v : mesh.vertices) {
    const Vec3 p = to_vec3(v.position);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  EXPECT_NEAR(low.y, -3.15 / 2 / 3.6, 1e-6);
  EXPECT_NEAR(high.y, 3.15 / 2 / 3.6, 1e-6);
  EXPECT_NEAR(low.z, -high.z, 1e-6);
}

TEST(Shapes, RefuseSizesOutOfRange) {
  EXPECT_THROW(make_sphere(2, 8), Error);
  EXPECT_THROW(make_torus_knot(8, 9000), Error);
  EXPECT_THROW(make_teapot(0), Error);
  EXPECT_THROW(make_shape(Shape::sphere, 63), Error);
  EXPECT_FALSE(parse_shape("cube"));
}

}  // namespace
}  // namespace burnish
