// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/export/html_page.h>
#include <burnish/export/web.h>
#include <burnish/export/web_module.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/shaders/shader.h>

namespace burnish {

namespace {

using nlohmann::json;

template <class T>
std::string base64_of(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

// Position, normal and tangent in steps of 1/32767.
json teapot() {
  const Mesh mesh = make_teapot(10);
  std::vector<std::int16_t> vertices;
  for (const Vertex& v : mesh.vertices)
    for (const auto& part : {v.position, v.normal, v.tangent})
      for (const float x : part) vertices.push_back(static_cast<std::int16_t>(std::lround(32767 * x)));
  std::vector<std::uint16_t> indices;
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  return {{"vertices", base64_of(vertices)}, {"indices", base64_of(indices)}};
}

json texel_entry(const GlTexture& texture) {
  return {{"name", texture.name},
          {"width", texture.width},
          {"height", texture.height},
          {"depth", texture.depth},
          {"rgba16f", half_texels(texture.values, texture.channels)}};
}

// The shader's call at a pixel of the page.
std::string call_of(const LightShader& light) {
  std::string call = light.function + "(normal";
  for (const std::string& argument : light.arguments)
    call += argument == "t" ? ", tangent" : argument == "s" ? ", cross(normal, tangent)" : "";
  return call + ", view)";
}

json light_entry(const LightShader& light) {
  auto textures = json::array();
  for (const GlTexture& texture : light.textures) textures.push_back(texel_entry(texture));
  return {{"shader", light.text}, {"call", call_of(light)}, {"textures", textures}};
}

std::string page_of(json model) {
  model["teapot"] = teapot();
  std::string text = model.dump(-1, ' ', true, json::error_handler_t::replace);
  // no </script> and no <!-- within the script
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");

  // the script stands in the page that names it
  constexpr std::string_view kScript = R"(<script src="page.js">)";
  std::string page(text_of(web_files(), "page.html"));
  return page.replace(page.find(kScript), kScript.size(), "<script>\n" + web_script("page.js", text));
}

}  // namespace

std::string html_page(const FactoredBrdf& brdf, const std::string& name, const SurfaceLight* light) {
  std::optional<LightShader> around;
  if (light) around = light->shader(ShaderLanguage::glsl_es, name);
  const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl_es, ShaderFilter::hardware, name});
  json model{{"name", name},
             {"expression", model_expression(brdf)},
             {"shader", shader.text},
             {"textures", json::array()}};
  for (const ShaderTexture& texture : shader.textures)
    model["textures"].push_back(texel_entry(upload_of(texture, TableFormat::half, true)));
  if (around) model["environment"] = light_entry(*around);
  return page_of(std::move(model));
}

std::string html_page(const SpatialBrdf& surface, const std::string& name) {
  return page_of(web_model(surface, name));
}

std::string html_page(const SpecularModel& model, const std::string& expression, const std::string& name) {
  return page_of(web_model(generate_shader(model, ShaderLanguage::glsl_es, name), expression, name));
}

std::string html_page(const OpenPbr& material, const std::string& name) {
  return page_of(web_model(material, name));
}

}  // namespace burnish
