#include <string_view>

#include <nlohmann/json.hpp>

#include <burnish/export/web.h>
#include <burnish/export/web_module.h>
#include <burnish/shaders/shader.h>

namespace burnish {

namespace {

// The script with what both of them read of a model: shader and textures.
std::string module_of(std::string_view script, const FactoredBrdf& brdf, const std::string& name) {
  const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl_es, ShaderFilter::hardware, name});
  nlohmann::json model{{"name", name}, {"expression", model_expression(brdf)}, {"shader", shader.text}};
  model["textures"] = nlohmann::json::array();
  for (const ShaderTexture& texture : shader.textures)
    model["textures"].push_back({{"name", texture.name},
                                 {"width", texture.width},
                                 {"height", texture.height},
                                 {"depth", texture.depth},
                                 {"rgba16f", half_texels(texture.values, texture.channels)}});
  return web_script(script, model.dump(1, ' ', true, nlohmann::json::error_handler_t::replace));
}

}  // namespace

std::string three_module(const FactoredBrdf& brdf, const std::string& name) {
  return module_of("three.js", brdf, name);
}

std::string babylon_module(const FactoredBrdf& brdf, const std::string& name) {
  return module_of("babylon.js", brdf, name);
}

}  // namespace burnish
