// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <burnish/factors/table_format.h>
#include <burnish/shaders/map_packing.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// The data that is uploaded to a texture: 2-D, 1-D where height is 0, 3-D where depth is not 0; clamped to the edge,
/// one level.
struct GlTexture {
  std::string name;  ///< of its sampler in the shader
  int width = 1, height = 1, depth = 0;
  std::size_t channels = 1;  ///< 1 or 3
  TableFormat precision = TableFormat::single;
  bool filtered = false;  ///< linear between texels, else the nearest
  std::vector<float> values;
};

/// A shader's texture in another precision.
inline GlTexture upload_of(const ShaderTexture& texture, TableFormat precision, bool filtered) {
  return {.name = texture.name,
          .width = texture.width,
          .height = texture.height,
          .depth = texture.depth,
          .channels = texture.channels,
          .precision = precision,
          .filtered = filtered,
          .values = texture.values};
}

/// Uploads it. Throws Error for a precision other than half, single and rgb9e5 (of three channels).
unsigned upload_texture(const GlTexture& texture);
/// A surface's maps with their levels, repeated, linear within and between levels; as bytes and halves, or with
/// `single` as floats of what these are, which no unit rounds while it filters.
unsigned upload_texture(const MapTexture& texture, bool single = false);

/// Links shaders given as pairs of type and source without their `#version 450` line. Throws Error with what
/// the driver says if it refuses them.
struct GlShaderSource {
  unsigned type;
  std::string text;
};
unsigned link_program(std::span<const GlShaderSource> shaders);

}  // namespace burnish
