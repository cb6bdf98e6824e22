// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <burnish/export/export_model.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Adds functions that draw directions in every language of `options.to`, the texture that all but C++ read, and what
/// the manifest says of them. Throws Error without a language, and as generate_shader does.
void add_sampler(BrdfRef brdf, const ExportOptions& options, ExportedFiles& result, nlohmann::json& manifest);

}  // namespace burnish
