// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/export/exported_files.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

/// Returns a MaterialX 1.39 document of a factored BRDF, NAME.mtlx, and the files beside it. The document defines a
/// material NAME and its BSDF node `burnish_NAME_bsdf`, for code in GLSL alone (targets genglsl, genessl and those
/// that inherit from them). That code is NAME.mtlx.glsl. It reads NAME.tables.exr and NAME.volumes.exr (the layers
/// above each other), whose first row is at v = 0. Light from all around is reflected as `core` does it. Throws Error
/// as generate_shader does. Source: [MaterialX 2024].
std::vector<ExportedFile> materialx_files(const FactoredBrdf& brdf, const MetallicRoughness& core,
                                          ShaderFilter filter, const std::string& name);

/// A document of a material NAME that is one open_pbr_surface node. Throws Error for a name that
/// check_shader_name refuses. Source: [MaterialX 2024], [OpenPBR 2024].
ExportedFile materialx_file(const OpenPbrParameters& parameters, const std::string& name);

}  // namespace burnish
