// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/surface/surface_file.h>

namespace burnish::cli {

/// Describes a surface for `burnish info`, as lines or as JSON: size, lobes, maps, the largest share of light that a
/// texel reflects, and the notes of its fit.
std::string surface_info(const SurfaceModel& surface, const std::string& name);
std::string surface_info_json(const SurfaceModel& surface, const std::string& name);

}  // namespace burnish::cli
