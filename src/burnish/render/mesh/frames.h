// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/render/mesh/mesh.h>

namespace burnish {

/// The mesh of a file: triangles whose corners have places, and perhaps the rest.
struct RawMesh {
  std::vector<Vec3> positions;                  ///< three a triangle, corner after corner
  std::vector<Vec3> normals;                    ///< of the same corners, or empty
  std::vector<std::array<double, 2>> uvs;       ///< of the same corners, or empty
  std::vector<std::array<double, 4>> tangents;  ///< of the same corners, x, y, z and side, or empty
};

/// The normals of a mesh that has none: those of the triangles, or smooth ones, which weigh the triangles at a place
/// by their angles.
enum class MissingNormals { flat, smooth };

/// Gives every corner a frame and joins corners that are the same. Given tangents are made orthogonal to the
/// normals and kept. Else, with texture coordinates, tangents are those of [Mikkelsen 2008], which normal
/// maps are baked with: along u, averaged by angle over the triangles around a corner that share its place,
/// normal and coordinates, are joined by edges and map the same way round; corners whose
/// triangles are mirrored get side -1. Without coordinates: tangent_around_y. Zero normals count as missing
/// ones.
Mesh finish_mesh(const RawMesh& raw, MissingNormals missing);

}  // namespace burnish
