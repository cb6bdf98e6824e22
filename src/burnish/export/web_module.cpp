// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include <burnish/export/tsl_function.h>
#include <burnish/export/web.h>
#include <burnish/export/web_module.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/analytic/openpbr_expression.h>
#include <burnish/shaders/openpbr_shader.h>
#include <burnish/shaders/shader.h>
#include <burnish/shaders/shader_formula.h>
#include <burnish/shaders/spatial_shader.h>

namespace burnish {

namespace {

using nlohmann::json;

json entry_of(const ShaderTexture& texture) {
  return {{"name", texture.name},
          {"width", texture.width},
          {"height", texture.height},
          {"depth", texture.depth},
          {"rgba16f", half_texels(texture.values, texture.channels)}};
}

// Writes the part of a model that all scripts read.
template <class Shader>
json shared(const FactoredBrdf& brdf, const std::string& name, const Shader& shader) {
  json model{{"name", name},
             {"expression", model_expression(brdf)},
             {"shader", shader.text},
             {"textures", json::array()}};
  for (const ShaderTexture& texture : shader.textures) model["textures"].push_back(entry_of(texture));
  return model;
}

std::string module_of(std::string_view script, const json& model) {
  return web_script(script, model.dump(1, ' ', true, json::error_handler_t::replace));
}

// Writes both materials of three.js: the script that has the model, then the one that makes nodes of its formula.
std::string both_materials(json model, const MetallicRoughness& core, const Expr& value) {
  model["color"] = {core.base_color.r, core.base_color.g, core.base_color.b};
  model["core"] = {{"metalness", core.metallic},
                   {"roughness", core.roughness},
                   {"anisotropy", core.anisotropy},
                   {"anisotropyRotation", core.across ? kPi / 2 : 0.0}};
  return module_of("three.js", model) + std::string(text_of(web_files(), "three_nodes.js")) +
         tsl_function(value);
}

json model_of(const FactoredBrdf& brdf, const std::string& name) {
  return shared(brdf, name, generate_shader(brdf, {ShaderLanguage::glsl_es, ShaderFilter::hardware, name}));
}

}  // namespace

json web_model(const SpatialBrdf& surface, const std::string& name) {
  const SpatialShader shader =
      generate_shader(surface, {ShaderLanguage::glsl_es, ShaderFilter::hardware, name});
  json model = shared(surface.lobes(), name, shader);
  for (const MapTexture& map : shader.maps.textures) {
    json levels = json::array();
    for (const std::vector<std::byte>& level : map.levels) levels.push_back(base64(level));
    model["maps"].push_back({{"name", map.name},
                             {"width", map.width},
                             {"height", map.height},
                             {"half", map.format == TableFormat::half},
                             {"levels", std::move(levels)}});
  }
  model["framed"] = shader.maps.normals || shader.maps.tangents;
  return model;
}

json web_model(const Shader& shader, const std::string& expression, const std::string& name) {
  return {{"name", name}, {"expression", expression}, {"shader", shader.text}, {"textures", json::array()}};
}

json web_model(const OpenPbr& material, const std::string& name) {
  return web_model(generate_shader(material, ShaderLanguage::glsl_es, name),
                   format_analytic(analytic_openpbr(material.parameters())), name);
}

std::string three_module(const FactoredBrdf& brdf, const MetallicRoughness& core, const std::string& name) {
  return both_materials(model_of(brdf, name), core,
                        shader_formula(brdf, {ShaderLanguage::glsl_es, ShaderFilter::hardware, name}).value);
}

std::string three_module(const SpatialBrdf& surface, const std::string& name) {
  return module_of("three.js", web_model(surface, name));
}

std::string three_module(const OpenPbr& material, const MetallicRoughness& core, const std::string& name) {
  return both_materials(web_model(material, name), core, openpbr_expression(material));
}

std::string babylon_module(const FactoredBrdf& brdf, const std::string& name) {
  return module_of("babylon.js", model_of(brdf, name));
}

std::string babylon_module(const OpenPbr& material, const std::string& name) {
  return module_of("babylon.js", web_model(material, name));
}

}  // namespace burnish
