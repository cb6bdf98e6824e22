// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <burnish/export/exported_files.h>
#include <burnish/export/nearest_material.h>
#include <burnish/reflectance/metallic_roughness.h>
#include <burnish/render/gl/gl_objects.h>
#include <burnish/textures/ktx2.h>

namespace burnish {

// The entries of an export's manifest about its files.

/// "NAME.glsl" and the like.
std::string shader_file(ShaderLanguage language, const std::string& name);

/// Returns the name of a texture in files and MaterialX's inputs: "volumes" of a 3-D one, else "tables".
std::string_view kind_of(const ShaderTexture& texture) noexcept;
/// "NAME.tables.ktx2" and the like.
std::string texture_file(const ShaderTexture& texture, const std::string& name, std::string_view ending);

nlohmann::json manifest_entry(ShaderLanguage language, const std::string& name, const Shader& shader);
nlohmann::json manifest_entry(const std::string& file, const Texture& texture);
/// Which table, and how its positions are warped.
nlohmann::json manifest_entry(const Table& table);
/// A texture of light from all around.
nlohmann::json manifest_entry(const std::string& file, const GlTexture& texture);

/// Returns the entry for glTF: the material without its name, and its score.
nlohmann::json gltf_entry(const NearestGltf& nearest);

/// The error figures among the notes of a model's file, a JSON object, and what they compare with; null where there are
/// none.
nlohmann::json errors_entry(const std::string& notes);

/// A core material as glTF has it; the direction of anisotropy is that of KHR_materials_anisotropy, in radians.
nlohmann::json core_entry(const MetallicRoughness& material);

/// NAME.json.
ExportedFile manifest_file(const nlohmann::json& manifest, const std::string& name);

}  // namespace burnish
