// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/render/light/environment_light.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// The targets that a model can be written as.
enum class ExportTarget {
  ktx2,       ///< the textures that shaders read
  dds,        ///< the same as DDS
  cube,       ///< tables of one direction as cube maps, KTX2
  exr,        ///< a table an OpenEXR image
  png,        ///< a table a PNG image
  gltf,       ///< GLB: the nearest material with extensions, the factors in one of ours
  materialx,  ///< a MaterialX document, with a node of its own where the model is factored
  usda,       ///< a USD layer: the nearest OpenPBR and a preview surface
  mdl,        ///< an MDL module and its measured BSDF
  three,      ///< a module that makes a material of three.js
  babylon,    ///< a module that makes a material of Babylon.js
  rgl,        ///< a table of the RGL database's format
  html,       ///< a page that shows the material
  // shaders, in the order of ShaderLanguage
  glsl,
  glsl_es,
  hlsl,
  msl,
  slang,
  wgsl,
  cpp,
};

/// In the order of ExportTarget, by the names that export_target takes.
std::span<const std::string_view> export_target_names() noexcept;
std::string_view to_string(ExportTarget target) noexcept;
/// Throws Error naming all targets.
ExportTarget export_target(std::string_view name);

/// The language of a shader; nothing for other targets.
std::optional<ShaderLanguage> language_of(ExportTarget target) noexcept;
/// Returns true if the target is a language that can multiply in half precision: all but C++.
bool has_half_products(ExportTarget target) noexcept;
/// Returns true if the target has numbers of bindings or registers: glsl, hlsl, slang and wgsl.
bool has_bindings(ExportTarget target) noexcept;
/// Returns true if the target has sets or groups: glsl, slang and wgsl.
bool has_sets(ExportTarget target) noexcept;
/// Returns true if the target has register spaces: hlsl.
bool has_spaces(ExportTarget target) noexcept;
/// Returns true if the target can show light from all around: glsl, glsl_es and html.
bool shows_environment(ExportTarget target) noexcept;

/// Returns true if the target is a shader language.
bool is_language(ExportTarget target) noexcept;

/// Returns the names of targets as messages have them: "exr, glsl_es".
std::string names_of(std::span<const ExportTarget> targets);

/// Returns the targets for which the predicate holds, languages first, as a sentence has them: "glsl, glsl_es or html".
std::string targets_that(bool (*are_so)(ExportTarget target) noexcept);

/// Returns the name of an export's functions and files, made of a text's letters and digits; "brdf" where it has
/// none.
std::string export_name(std::string_view text);

struct ExportedFile {
  std::string name, bytes;
};

/// The cost of an exported shader.
struct ExportedShader {
  std::string file;
  /// "exact filter" or "hardware filter", this also with ", half products"; or the name of the power's method.
  std::string how;
  ShaderCost cost;
};

/// Files in memory. The last one, NAME.json, is the manifest: what the others are, how they are read and what
/// an evaluation costs; see docs/guide/shaders.md.
struct ExportedFiles {
  std::vector<ExportedFile> files;
  std::vector<ExportedShader> shaders;
  /// Losses of tables that stand for the model, as convert reports them, each after its file's name.
  std::vector<std::string> losses;

  void lose(const std::string& file, std::span<const std::string> of_file) {
    for (const std::string& loss : of_file) losses.push_back(file + ": " + loss);
  }
};

/// Writes each file by write_then_rename into the folder, made where it is missing. Throws Error where that
/// cannot be done.
void write_files(const std::filesystem::path& folder, std::span<const ExportedFile> files);

}  // namespace burnish
