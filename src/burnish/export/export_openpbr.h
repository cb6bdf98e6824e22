#pragma once

#include <string>

#include <burnish/export/export_model.h>

namespace burnish {

/// OpenPBR, such as "openpbr:base_color=0.8/0.2/0.1,coat_weight=1", as materialx, usda, mdl, gltf and rgl, in
/// the order of `options.to`; of the other options only name and cells count. Throws Error as parse_analytic
/// does, for other models, and for other targets, which take a factored BRDF of it.
ExportedFiles export_openpbr(const std::string& spec, const ExportOptions& options);

}  // namespace burnish
