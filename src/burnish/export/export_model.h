// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burnish/export/exported_files.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/render/light/environment_light.h>

namespace burnish {

struct ExportOptions {
  std::vector<ExportTarget> to;
  std::string name =
      "brdf";              ///< of functions and files: letters, digits and single underscores, a letter first
  bool exact = false;      ///< shaders weigh texels themselves, in floats; always so in C++
  bool half = false;       ///< shaders multiply texels in half precision; never in C++
  bool mips = false;       ///< KTX2 a table with levels too: averages over the directions of a texel
  bool compressed = true;  ///< KTX2 with Zstandard
  bool blocks = false;     ///< KTX2 of a surface's maps as pairs in blocks, and shaders that read these
  /// Also writes shaders of area lights, see lighting/area_light_shader.h; their fit takes seconds.
  bool area = false;
  bool sample = false;  ///< also writes shaders that draw directions, see shaders/sampler_shader.h
  int cells = 90;       ///< of mdl: along each polar angle, in [2, 1000]; twice as many along the azimuth
  /// Numbers of bindings, sets and spaces in shaders; each needs a target that has them.
  ShaderPlaces places = {};
  bool appended = false;     ///< shaders go behind others in a file: without `enable f16` of WGSL
  std::string notes = "{}";  ///< of the model's file, JSON; its error figures go to the manifest
  /// Light from all around, for the targets of shows_environment.
  std::optional<Environment> environment = {};
};

/// Throws Error for places that no target has, and for places with an environment.
void check_places_shown(const ExportOptions& options);

/// Writes a factored BRDF as every target of `to`, each once. All shaders but C++ bring their textures along. The
/// target gltf has the nearest material of glTF, and usda the nearest OpenPBR and core material, which take seconds to
/// find. Throws Error as generate_shader does, and for:
/// - an environment that no target shows;
/// - area lights without a language that has textures, and `sample` without a language;
/// - half without a language that has it, or with `exact`;
/// - places that no target has, that are below 0, or with an environment, whose shaders have none;
/// - glTF of other than 1 or 3 channels.
ExportedFiles export_model(const FactoredBrdf& brdf, const ExportOptions& options);

}  // namespace burnish
