// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/export/export_model.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {

/// OpenPBR as materialx, usda, mdl, gltf, rgl, three, babylon, html and shaders, in the order of `options.to`; of the
/// other options only name and cells count. Throws Error for other models, and for targets that are tables, which take
/// a factored BRDF of it.
ExportedFiles export_openpbr(const AnalyticBrdf& brdf, const ExportOptions& options);

}  // namespace burnish
