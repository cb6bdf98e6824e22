// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/render/gl/gl_objects.h>

namespace burnish {

/// The two arguments of one call.
struct GlVectors {
  float a[3], b[3];
};

/// Calls a GLSL function `vec3 name(vec3, vec3)` for many arguments, as a compute shader. Needs a GlContext
/// that is current, for as long as it lives.
class GlFunction {
 public:
  /// `text` has no #version line. Throws Error if the driver refuses it (with what it says).
  GlFunction(const std::string& text, const std::string& name);
  ~GlFunction();
  GlFunction(const GlFunction&) = delete;
  GlFunction& operator=(const GlFunction&) = delete;

  /// Gives a texture to the sampler of its name. Throws Error as upload_texture.
  void set_texture(const GlTexture& texture);
  /// The same of a surface's maps; see upload_texture.
  void set_texture(const MapTexture& texture, bool single);

  /// Gives numbers to `readonly buffer` of the text with `layout(std430, binding = 2)`, an array of floats. The call
  /// that asks is gl_GlobalInvocationID.x.
  void set_numbers(std::span<const float> numbers);

  /// Three values a call. At most kMaxCalls.
  std::vector<float> call(std::span<const GlVectors> arguments) const;

  static constexpr std::size_t kMaxCalls = 64 * 65535;

 private:
  void add_texture(const std::string& name, unsigned texture);

  unsigned program_ = 0;
  std::vector<unsigned> textures_;
  std::vector<unsigned> numbers_;  // a buffer, if there is one
};

}  // namespace burnish
