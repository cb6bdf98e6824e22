// SPDX-License-Identifier: Apache-2.0
// burnish_mesh_frames MESH VERTICES prints the corners of triangles for tests/web/frames.mjs, 15 floats each. They are
// position, normal, texture coordinates, the tangent and side that finish_mesh computes from these, and the renderer's
// tangent. For built-in meshes the renderer's tangent is that of the exact surface.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/mesh/frames.h>
#include <burnish/render/mesh/mesh_file.h>
#include <burnish/render/mesh/shapes.h>

namespace burnish {
namespace {

void print_frames(const Mesh& mesh) {
  RawMesh raw;
  for (const auto& triangle : mesh.triangles)
    for (const auto corner : triangle) {
      const Vertex& v = mesh.vertices[corner];
      raw.positions.push_back(to_vec3(v.position));
      raw.normals.push_back(to_vec3(v.normal));
      raw.uvs.push_back({v.uv[0], v.uv[1]});
    }
  const Mesh framed = finish_mesh(raw, MissingNormals::flat);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex &v = framed.vertices[framed.triangles[t][k]], &own = mesh.vertices[mesh.triangles[t][k]];
      for (const auto& list : {std::span<const float>(v.position), std::span<const float>(v.normal),
                               std::span<const float>(v.uv), std::span<const float>(v.tangent),
                               std::span<const float>(&v.side, 1), std::span<const float>(own.tangent)})
        std::fwrite(list.data(), sizeof(float), list.size(), stdout);
    }
}

}  // namespace
}  // namespace burnish

int main(int count, char** arguments) {
  try {
    if (count != 3) throw burnish::Error("expected MESH VERTICES");
    if (const auto shape = burnish::parse_shape(arguments[1]))
      burnish::print_frames(burnish::make_shape(*shape, std::atoi(arguments[2])));
    else
      for (const burnish::MeshPart& part : burnish::read_mesh(arguments[1]).parts)
        burnish::print_frames(part.mesh);
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_mesh_frames: {}\n", error.what());
    return 1;
  }
}
