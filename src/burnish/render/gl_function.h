#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

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

  /// Gives a sampler its texture of one level, clamped to the edge, `channels` 1 or 3, halves or floats, from
  /// values of a depth of 1 (2-D) or more (3-D).
  struct Texels {
    int width = 0, height = 0, depth = 0;  ///< depth 0: 2-D
    int channels = 0;
    bool half = false, linear = false;
    std::span<const float> values;
  };
  void set_texture(const std::string& sampler, const Texels& texels);

  /// Three values a call. At most kMostCalls.
  std::vector<float> call(std::span<const GlVectors> arguments) const;

  static constexpr std::size_t kMostCalls = 64 * 65535;

 private:
  unsigned program_ = 0;
  std::vector<unsigned> textures_;
};

}  // namespace burnish
