// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/baselines/node_table.h>
#include <burnish/shaders/shader.h>
#include <burnish/testing/models.h>

namespace burnish {

/// The filter of table reads, and whether tables hold halves or floats.
struct ShaderVariant {
  ShaderFilter filter;
  bool halves;
};
inline constexpr ShaderVariant kShaderVariants[] = {{ShaderFilter::exact, false},
                                                    {ShaderFilter::exact, true},
                                                    {ShaderFilter::hardware, false},
                                                    {ShaderFilter::hardware, true}};
/// The largest relative error of each of kShaderVariants.
using VariantErrors = std::array<double, std::size(kShaderVariants)>;

inline constexpr const char* kWebGlRun = R"(
const floats = async (file) => new Float32Array(await (await fetch(file)).arrayBuffer());
const gl = document.createElement("canvas").getContext("webgl2");
if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("no float targets");
const filtered_floats = gl.getExtension("OES_texture_float_linear");
function texture(unit, format, filter, {width, height, depth}, rgba) {
  const t = gl.createTexture(), kind = depth ? gl.TEXTURE_3D : gl.TEXTURE_2D;
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(kind, t);
  if (depth) gl.texImage3D(kind, 0, format, width, height, depth, 0, gl.RGBA, gl.FLOAT, rgba);
  else gl.texImage2D(kind, 0, format, width, height, 0, gl.RGBA, gl.FLOAT, rgba);
  for (const use of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(kind, use, filter);
  for (const use of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
    gl.texParameteri(kind, use, gl.CLAMP_TO_EDGE);
  return t;
}
const shader = (type, text) => {
  const s = gl.createShader(type);
  gl.shaderSource(s, "#version 300 es\n" + text);
  gl.compileShader(s);
  return s;
};
// Relative to the truth, times `lenience`.
function worst_error(variant, textures, truth, lenience) {
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1);
  }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, variant.shader + `
    uniform sampler2D all_wi, all_wo;
    out vec4 value;
    void main() {
      ivec2 at = ivec2(gl_FragCoord.xy);
      value = vec4(burnish_m(texelFetch(all_wi, at, 0).xyz, texelFetch(all_wo, at, 0).xyz), 1);
    }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  const set = (name, unit) => gl.uniform1i(gl.getUniformLocation(program, name), unit);
  set("all_wi", 0);
  set("all_wo", 1);
  const made = textures.map((t, i) => {
    set(t.name, 2 + i);
    return texture(2 + i, variant.halves ? gl.RGBA16F : gl.RGBA32F, variant.filtered ? gl.LINEAR : gl.NEAREST, t,
                   variant.halves ? t.halves : t.floats);
  });
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  made.forEach((t) => gl.deleteTexture(t));
  let worst = gl.getError() === 0 ? 0 : NaN;
  for (let i = 0; i < side * side; ++i)
    for (let c = 0; c < 3; ++c) {
      const f = found[4 * i + c], t = truth[3 * i + c];
      worst = Math.max(worst, t > 0 ? Math.abs(f / t - 1) * lenience[i] : f === 0 ? 0 : NaN);
    }
  return worst;
}
const found = new Float32Array(4 * side * side), square = {width: side, height: side};
(async () => {
  texture(0, gl.RGBA32F, gl.NEAREST, square, await floats("wi"));
  texture(1, gl.RGBA32F, gl.NEAREST, square, await floats("wo"));
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  const target = texture(15, gl.RGBA32F, gl.NEAREST, square, null);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, side, side);
  const results = [];
  for (const [i, model] of models.entries()) {
    const truth = await floats(`truth${i}`), lenience = await floats(`lenience${i}`);
    for (const t of model.textures) {
      t.floats = await floats(t.file);
      t.halves = await floats(t.file + "_half");
    }
    for (const variant of model.variants)
      results.push(variant.filtered && !variant.halves && !filtered_floats
                     ? NaN : worst_error(variant, model.textures, truth, lenience));
  }
  document.body.dataset.result = results.join(" ");
})();
)";

/// Writes a page into `folder`, and the numbers that it loads. The page evaluates the models' generated GLSL
/// ES in WebGL2 at side^2 pairs, in each of kShaderVariants. It leaves the largest relative errors in
/// data-result of its body, divided by the factor of shader_cancellation.
inline void write_webgl_page(std::span<const ModelCase> models, int side,
                             const std::filesystem::path& folder) {
  const auto put = [&](const std::string& name, const std::vector<float>& values) {
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
  };
  const auto pairs = corner_and_random_pairs(side * side);
  const auto single = [](double x) { return static_cast<float>(x); };
  std::vector<float> wi, wo;
  for (const auto& pair : pairs) {
    wi.insert(wi.end(), {single(pair.wi.x), single(pair.wi.y), single(pair.wi.z), 1});
    wo.insert(wo.end(), {single(pair.wo.x), single(pair.wo.y), single(pair.wo.z), 1});
  }
  put("wi", wi);
  put("wo", wo);
  std::string text = fmt::format("<!DOCTYPE html><body><script>const side = {}, models = [", side);
  for (std::size_t m = 0; m < models.size(); ++m) {
    const FactoredBrdf brdf = smooth_model(models[m]);
    text += "{variants: [";
    std::vector<ShaderTexture> textures;
    for (const auto& [filter, halves] : kShaderVariants) {
      const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl_es, filter, "m"});
      text += fmt::format("{{halves: {}, filtered: {}, shader: `{}`}},", halves,
                          filter == ShaderFilter::hardware, shader.text);
      textures = shader.textures;
    }
    text += "], textures: [";
    for (std::size_t i = 0; i < textures.size(); ++i) {
      const ShaderTexture& texture = textures[i];
      std::vector<float> rgba, halves;
      for (std::size_t k = 0; k < texture.values.size() / texture.channels; ++k)
        for (std::size_t c = 0; c < 4; ++c) {
          rgba.push_back(texture.channels == 1 ? texture.values[k] : c == 3 ? 1 : texture.values[3 * k + c]);
          halves.push_back(round_to_half(rgba.back()));
        }
      const std::string file = fmt::format("table{}_{}", m, i);
      put(file, rgba);
      put(file + "_half", halves);
      text += fmt::format("{{name: '{}', width: {}, height: {}, depth: {}, file: '{}'}},", texture.name,
                          texture.width, texture.height, texture.depth, file);
    }
    text += "]},";
    std::vector<float> truth, lenience;
    for (const auto& [a, b] : pairs) {
      double f[3];
      brdf.eval(a, b, std::span(f).first(brdf.channels()));
      for (int c = 0; c < 3; ++c) truth.push_back(single(f[brdf.channels() == 1 ? 0 : c]));
      lenience.push_back(single(1 / shader_cancellation(brdf, a, b)));
    }
    put(fmt::format("truth{}", m), truth);
    put(fmt::format("lenience{}", m), lenience);
  }
  std::ofstream(folder / "page.html") << text << "];" << kWebGlRun << "</script></body>";
}

/// Returns the errors that Chromium finds for each model of the page. An error is NaN if Chromium cannot
/// filter floats. The result is empty if Chromium does not run.
inline std::vector<VariantErrors> run_webgl(std::span<const ModelCase> models, int side,
                                            const std::filesystem::path& folder) {
  write_webgl_page(models, side, folder);
  const int code = std::system(
      fmt::format("timeout 300 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
                  "--enable-unsafe-swiftshader --allow-file-access-from-files --user-data-dir={0}/profile "
                  "--virtual-time-budget=5000 --dump-dom file://{0}/page.html > {0}/dom 2> {0}/said",
                  folder.string())
          .c_str());
  if (code != 0) return {};
  std::ostringstream dom;
  dom << std::ifstream(folder / "dom").rdbuf();
  const std::string text = dom.str(), mark = "data-result=\"";
  const auto at = text.find(mark);
  if (at == text.npos) return {};
  std::istringstream results(text.substr(at + mark.size()));
  std::vector<VariantErrors> worst(models.size());
  for (VariantErrors& errors : worst)
    for (double& error : errors) {
      std::string word;
      results >> word;
      error = word.empty() || word.starts_with("NaN") ? std::numeric_limits<double>::quiet_NaN()
                                                      : std::strtod(word.c_str(), nullptr);
    }
  return worst;
}

}  // namespace burnish
