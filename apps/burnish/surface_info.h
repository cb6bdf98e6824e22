#pragma once

#include <string>

#include <burnish/surface/surface_file.h>

namespace burnish::cli {

/// What `burnish info` says of a surface: size, lobes, maps, the largest share of light that a texel reflects, and what
/// its fit wrote down; as lines or as JSON.
std::string surface_info(const SurfaceModel& surface, const std::string& name);
std::string surface_info_json(const SurfaceModel& surface, const std::string& name);

}  // namespace burnish::cli
