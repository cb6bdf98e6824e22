// SPDX-License-Identifier: Apache-2.0
#pragma once

// For the library and its programs: JSON before it is text.

#include <nlohmann/json_fwd.hpp>

#include <burnish/capture/surface_fit.h>

namespace burnish {

/// Returns "capture", "flat" or "estimated".
const char* name_of(NormalsFrom normals) noexcept;

/// Returns the JSON object that report_json writes.
nlohmann::ordered_json json_of(const SurfaceReport& report);

}  // namespace burnish
