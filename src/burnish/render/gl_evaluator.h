#pragma once

#include <span>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// wi and wo of one evaluation, unit vectors of the local frame.
struct GlDirections {
  float wi[3], wo[3];
};

/// Evaluates a factored BRDF by its GLSL shader, as a compute shader. Needs a GlContext that is current, for
/// as long as it lives.
class GlEvaluator {
 public:
  /// `precision` is that of the textures: half or single. Throws Error if generate_shader does, for another
  /// precision, or if the driver refuses the shader (with what it says).
  GlEvaluator(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision);
  ~GlEvaluator();
  GlEvaluator(const GlEvaluator&) = delete;
  GlEvaluator& operator=(const GlEvaluator&) = delete;

  /// f_r in 1/sr, three values a pair. At most kMostPairs pairs.
  std::vector<float> eval(std::span<const GlDirections> pairs) const;

  static constexpr std::size_t kMostPairs = 64 * 65535;

 private:
  unsigned program_ = 0;
  std::vector<unsigned> textures_;
};

}  // namespace burnish
