// SPDX-License-Identifier: Apache-2.0
// These functions of the library are not used by pages: surfaces as OpenEXR, maps in blocks, area lights,
// and shaders that draw directions.
#include <burnish/error.h>
#include <burnish/export/sampler_files.h>
#include <burnish/image/block_compression.h>
#include <burnish/lighting/area_light_fit.h>
#include <burnish/lighting/area_light_shader.h>
#include <burnish/surface/surface_exr.h>

namespace burnish {

SurfaceModel read_surface_exr(const FileBytes& file) {
  throw Error::in_file(file.name, "the .burnish file of a surface, which `burnish convert` makes of it",
                       "its OpenEXR file");
}

std::string format_surface_exr(const SurfaceModel&) {
  throw Error("surface: expected .burnish to write, found OpenEXR");
}

std::string_view to_string(TexelBlocks) noexcept {
  return "none";
}

std::vector<std::byte> encode_bc5(int, int, std::span<const float>, bool) {
  throw Error("blocks: expected maps of single texels in a page, found blocks");
}

std::vector<float> decode_bc5(int, int, std::span<const std::byte>, bool) {
  throw Error("blocks: expected maps of single texels in a page, found blocks");
}

AreaLightTable fit_area_lights(BrdfRef, const AreaLightFitOptions&) {
  throw Error("export: expected no area lights in a page, found some");
}

AreaLightShader generate_shader(const AreaLightTable&, ShaderLanguage, const std::string&,
                                const ShaderPlaces&) {
  throw Error("shader: expected no area lights in a page, found some");
}

void add_sampler(BrdfRef, const ExportOptions&, ExportedFiles&, nlohmann::json&) {
  throw Error("export: expected no drawing of directions in a page, found some");
}

}  // namespace burnish
