// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_evaluator.h>

namespace burnish {

namespace {

Shader shader_of(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision) {
  if (precision != TableFormat::half && precision != TableFormat::single)
    throw Error(fmt::format("OpenGL: expected textures of half or float, found {}", to_string(precision)));
  return generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"});
}

}  // namespace

void set_textures(GlFunction& function, std::span<const ShaderTexture> textures, TableFormat precision,
                  bool filtered) {
  for (const ShaderTexture& texture : textures) function.set_texture(upload_of(texture, precision, filtered));
}

GlEvaluator::GlEvaluator(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision)
    : GlEvaluator(shader_of(brdf, filter, precision), precision, filter == ShaderFilter::hardware) {}

GlEvaluator::GlEvaluator(const Shader& shader, TableFormat precision, bool filtered)
    : function_(shader.text, "burnish_model") {
  set_textures(function_, shader.textures, precision, filtered);
}

}  // namespace burnish
