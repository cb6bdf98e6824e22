// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <burnish/file.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// A surface with what its file says about it.
struct SurfaceModel {
  SpatialBrdf brdf;
  std::string notes = "{}";  ///< a JSON object: capture, fit options, errors

  friend bool operator==(const SurfaceModel&, const SurfaceModel&) = default;
};

/// The `.burnish` file of a surface: that of its lobes (factors/compact_file.h), whose last item is
/// [version, width, height, normals and tangents there or not (bits 1 and 2), maps], a map being channels, format,
/// scale and the bytes of its level 0, weights first. Mip levels are made again when it is read. Version 2 has besides,
/// before the maps, the widened lobes, pairs of a lobe and a variance; these have no maps. Without widened
/// lobes version 1 is written. parse_surface restores all to the last bit. Throws Error as format_compact does.
std::string format_surface(const SurfaceModel& surface);

/// The OpenEXR file of a surface: that of its lobes (factors/model_file.h) with a part more a map, map_weight0, ...,
/// map_normals, map_tangents, as any viewer shows them: unorm8 as floats, halves as halves. parse_surface restores all
/// to the last bit. Throws Error where a table has a map's name.
std::string format_surface_exr(const SurfaceModel& surface);

/// The bytes of a surface's file by the ending of its name: format_surface_exr's for .exr, else format_surface's.
std::string format_surface_as(const std::filesystem::path& name, const SurfaceModel& surface);

/// Reads either file, known by its content. Throws Error, naming the file, and of .burnish the offset, if the bytes are
/// no such file or contradict themselves in any way. Memory taken is at most a fixed multiple of the file's size.
SurfaceModel parse_surface(const FileBytes& file);

/// True if the bytes start as a surface's file does; of OpenEXR they have to hold the first header.
bool looks_like_surface(std::span<const std::byte> head) noexcept;

}  // namespace burnish
