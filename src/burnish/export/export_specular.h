// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <burnish/export/export_model.h>
#include <burnish/power/power.h>

namespace burnish {

/// Phong's or Blinn's model, such as "blinn_phong:exponent=60,ks=0.8", as shaders and a page, in the order of
/// `options.to`; of the other options only the name counts. The power is computed by `power`, by default the
/// cheapest member of the specular family that is never one of 255 levels off. Throws Error as parse_analytic
/// and generate_shader do, for other models, and for targets that are neither a shader nor html.
ExportedFiles export_specular(const std::string& spec, std::optional<PowerMethod> power,
                              const ExportOptions& options);

}  // namespace burnish
