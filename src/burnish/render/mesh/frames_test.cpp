// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/render/mesh/frames.h>
#include <burnish/render/mesh/mesh_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

// A unit square, its coordinates turned.
RawMesh square(double turn) {
  RawMesh raw;
  for (const int k : {0, 1, 2, 0, 2, 3}) {
    const double x = k == 1 || k == 2, y = k >= 2;
    raw.positions.push_back({x, y, 0});
    raw.uvs.push_back({std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x});
  }
  return raw;
}

TEST(FinishMesh, TangentsFollowTheTextureAndKeepItsWayRound) {
  for (const double turn : {0.0, 0.7, 2.0, -1.1}) {
    RawMesh raw = square(turn);
    for (const Vertex& v : finish_mesh(raw, MissingNormals::flat).vertices) {
      EXPECT_NEAR(dot(to_vec3(v.tangent), {std::cos(turn), std::sin(turn), 0}), 1, 1e-6);
      EXPECT_EQ(v.side, 1);
    }
    for (auto& uv : raw.uvs) uv[0] = -uv[0];
    for (const Vertex& v : finish_mesh(raw, MissingNormals::flat).vertices) {
      EXPECT_NEAR(dot(to_vec3(v.tangent), {std::cos(turn), std::sin(turn), 0}), -1, 1e-6);
      EXPECT_EQ(v.side, -1);
    }
  }
}

TEST(FinishMesh, SplitsVerticesWhereTheTextureIsMirrored) {
  // two triangles beside each other along x = 1, the second with u running back
  RawMesh raw;
  raw.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  raw.uvs = {{0, 0}, {1, 0}, {1, 1}, {1, 0}, {0, 0}, {1, 1}};
  const Mesh mesh = finish_mesh(raw, MissingNormals::flat);
  EXPECT_EQ(mesh.vertices.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.vertices[mesh.triangles[0][i]].side, 1);
    EXPECT_EQ(mesh.vertices[mesh.triangles[1][i]].side, -1);
  }
  for (auto& uv : raw.uvs) uv[0] = 0.5;  // no area in the texture: any frame will do
  for (const Vertex& v : finish_mesh(raw, MissingNormals::flat).vertices)
    EXPECT_NEAR(length(to_vec3(v.tangent)), 1, 1e-6);
}

// [Mikkelsen 2008]
TEST(FinishMesh, WeighsTrianglesByTheirAngles) {
  // around the origin triangles of 90, 45 and 45 degrees; u runs along x in the first, along x + y in the
  // others
  RawMesh raw;
  const Vec3 rim[] = {{1, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}};
  const std::array<double, 2> uv[] = {{1, 0}, {0, 1}, {-1, 2}, {-2, 1}};
  for (std::size_t k = 0; k < 3; ++k) {
    raw.positions.insert(raw.positions.end(), {{0, 0, 0}, rim[k], rim[k + 1]});
    raw.uvs.insert(raw.uvs.end(), {{0, 0}, uv[k], uv[k + 1]});
  }
  const Mesh mesh = finish_mesh(raw, MissingNormals::flat);
  EXPECT_EQ(mesh.vertices.size(), 5u);
  const double middle = 3.141592653589793 / 8;
  EXPECT_NEAR(
      dot(to_vec3(mesh.vertices[mesh.triangles[0][0]].tangent), {std::cos(middle), std::sin(middle), 0}), 1,
      1e-6);
}

TEST(FinishMesh, TrianglesWithoutTexturePassTangentsOn) {
  // a fan around the origin whose second triangle has no area in the texture; the last one has no area at all
  RawMesh raw;
  const Vec3 rim[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0.5, 0}, {-1, 0.5, 0}};
  const std::array<double, 2> uv[] = {{1, 0}, {1, 1}, {1, 1}, {0.3, 1.5}, {0.5, 1.5}};
  for (std::size_t k = 0; k < 4; ++k) {
    raw.positions.insert(raw.positions.end(), {{0, 0, 0}, rim[k], rim[k + 1]});
    raw.uvs.insert(raw.uvs.end(), {{0, 0}, uv[k], uv[k + 1]});
  }
  raw.normals.assign(raw.positions.size(), {0, 0, 1});
  const Mesh mesh = finish_mesh(raw, MissingNormals::flat);
  for (std::size_t k = 1; k < 4; ++k) EXPECT_EQ(mesh.triangles[k][0], mesh.triangles[0][0]) << k;
}

TEST(FinishMesh, SmoothNormalsOfACubePointAlongItsDiagonals) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text +=
        "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " + std::to_string(i >> 2) + "\n";
  text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const MeshFile file = parse_obj(memory_file(text));
  EXPECT_EQ(file.parts[0].mesh.vertices.size(), 8u);
  for (const Vertex& v : file.parts[0].mesh.vertices) {
    const Vec3 outwards = normalize(to_vec3(v.position) - Vec3{0.5, 0.5, 0.5});
    EXPECT_NEAR(dot(to_vec3(v.normal), outwards), 1, 1e-6);
    EXPECT_NEAR(dot(to_vec3(v.tangent), tangent_around_y(outwards)), 1, 1e-6);
  }
}

}  // namespace
}  // namespace burnish
