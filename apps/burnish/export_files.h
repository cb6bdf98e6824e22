#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/gl/surface_environment.h>
#include <burnish/shaders/shader.h>

namespace burnish::cli {

/// A language of `--to` and how its files' names end.
struct ExportTarget {
  const char* name;
  const char* extension;
  ShaderLanguage language;
};
inline constexpr ExportTarget kExportTargets[] = {
    {"glsl", "glsl", ShaderLanguage::glsl}, {"glsl_es", "es.glsl", ShaderLanguage::glsl_es},
    {"hlsl", "hlsl", ShaderLanguage::hlsl}, {"msl", "metal", ShaderLanguage::msl},
    {"wgsl", "wgsl", ShaderLanguage::wgsl}, {"cpp", "h", ShaderLanguage::cpp},
};

struct ExportArguments {
  std::string model, folder, name, power, environment;
  std::vector<std::string> to;
  bool exact = false, plain = false, mips = false;
};

struct ExportedFile {
  std::string name, bytes;
};

/// Adds the textures that generated shaders read, and their entries to the manifest. Throws Error for levels
/// of tables that share a texture.
void add_textures(const FactoredBrdf& brdf, const ExportArguments& arguments,
                  std::vector<ExportedFile>& files, nlohmann::json& manifest);

/// Adds shaders of the light that comes from all around, in GLSL as far as it is asked for, with their
/// textures, and an entry of the manifest.
void add_light(const SurfaceLight& light, const ExportArguments& arguments, std::vector<ExportedFile>& files,
               nlohmann::json& manifest);

}  // namespace burnish::cli
