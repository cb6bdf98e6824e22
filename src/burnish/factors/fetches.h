// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_spec.h>

namespace burnish {

/// Filtered reads of tables that one evaluation takes: distinct tables and places in them, whatever the number of
/// lobes that multiply by what is read. The view's own lookups count too. A line, grid, disk or volume takes one read
/// each, as a texture unit makes it.
std::size_t fetch_count(const FactoredBrdf& brdf);
/// The same of a model without its numbers.
std::size_t fetch_count(const ModelSpec& spec);

/// Textures that hold its tables in a shader: one of lines, grids and disks, one of volumes.
std::size_t texture_count(const FactoredBrdf& brdf) noexcept;

}  // namespace burnish
