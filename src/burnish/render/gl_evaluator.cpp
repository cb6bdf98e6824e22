#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl_evaluator.h>

namespace burnish {

namespace {

Shader shader_of(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision) {
  if (precision != TableFormat::half && precision != TableFormat::single)
    throw Error(fmt::format("OpenGL: expected textures of half or float, found {}", to_string(precision)));
  return generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"});
}

}  // namespace

void set_tables(GlFunction& function, const FactoredBrdf& brdf, std::span<const std::string> samplers,
                TableFormat precision, bool filtered) {
  for (std::size_t i = 0; i < samplers.size(); ++i) {
    const Table& table = brdf.tables()[i];
    function.set_texture({.name = samplers[i],
                          .width = table.layout.width,
                          .height = table.layout.height,
                          .channels = table.channels,
                          .precision = precision,
                          .filtered = filtered,
                          .values = table.values});
  }
}

GlEvaluator::GlEvaluator(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision)
    : function_(shader_of(brdf, filter, precision).text, "burnish_model") {
  set_tables(function_, brdf, shader_of(brdf, filter, precision).textures, precision,
             filter == ShaderFilter::hardware);
}

}  // namespace burnish
