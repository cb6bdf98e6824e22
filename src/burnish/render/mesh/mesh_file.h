// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <burnish/file.h>
#include <burnish/render/mesh/mesh.h>

namespace burnish {

/// The contents of a mesh file: a part for every material it names, in their order of appearance.
struct MeshFile {
  std::vector<MeshPart> parts;
  std::vector<std::string> materials;  ///< their names, as the file has them; may be empty
};

/// Files with more triangles than this are refused.
inline constexpr std::size_t kMaxTriangles = std::size_t{1} << 25;

/// Wavefront OBJ: v, vt, vn, f (polygons as fans, indices from the end too) and usemtl; everything else is
/// passed over. Missing normals are smooth, tangents as finish_mesh finds them. Throws Error, with the line,
/// for what is no number, an index that is not there, a face of fewer than three corners, or no face at all.
MeshFile parse_obj(const FileBytes& file);

/// glTF 2.0, as JSON or binary: the triangles of the default scene's nodes (of all root nodes where there is
/// none), in world space; POSITION, NORMAL, TANGENT and TEXCOORD_0. Buffers are the binary chunk, data URIs
/// or files in `folder`. Missing normals are flat, as glTF says. Throws Error, with the place in the file,
/// for what is broken or not supported: sparse and compressed accessors, extensions that are required, other
/// primitives than triangles.
MeshFile parse_gltf(const FileBytes& file, const std::filesystem::path& folder);

/// Either, found by content. Throws Error if it cannot be read or is neither.
MeshFile read_mesh(const std::filesystem::path& path);

}  // namespace burnish
