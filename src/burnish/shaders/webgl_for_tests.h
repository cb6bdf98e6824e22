#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/factors/models_for_tests.h>
#include <burnish/shaders/shader.h>

namespace burnish {

inline constexpr const char* kWebGlRun = R"(
const floats = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
const wi = floats(pairs.wi), wo = floats(pairs.wo);
const gl = document.createElement("canvas").getContext("webgl2");
if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("no float targets");
function texture(unit, width, height, rgba) {
  const t = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, t);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, rgba);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return t;
}
const shader = (type, text) => {
  const s = gl.createShader(type);
  gl.shaderSource(s, "#version 300 es\n" + text);
  gl.compileShader(s);
  return s;
};
function evaluate(model) {
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1);
  }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, model.shader + `
    uniform sampler2D all_wi, all_wo;
    out vec4 value;
    void main() {
      ivec2 at = ivec2(gl_FragCoord.xy);
      value = vec4(burnish_m(texelFetch(all_wi, at, 0).xyz, texelFetch(all_wo, at, 0).xyz), 1);
    }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  const set = (name, unit) => gl.uniform1i(gl.getUniformLocation(program, name), unit);
  texture(0, side, side, wi);
  texture(1, side, side, wo);
  set("all_wi", 0);
  set("all_wo", 1);
  model.textures.forEach((t, i) => {
    texture(2 + i, t.width, t.height, floats(t.rgba));
    set(t.name, 2 + i);
  });
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture(15, side, side, null), 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  let worst = gl.getError() === 0 ? 0 : NaN;
  const lenience = floats(model.lenience);
  floats(model.truth).forEach((t, i) => {
    const f = found[i + Math.floor(i / 3)];
    worst = Math.max(worst, t > 0 ? Math.abs(f / t - 1) * lenience[Math.floor(i / 3)] : f === 0 ? 0 : NaN);
  });
  return worst;
}
document.body.dataset.result = models.map(evaluate).join(" ");
)";

inline std::string base64_floats(const std::vector<float>& values) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  const std::size_t size = 4 * values.size();
  std::string text;
  for (std::size_t i = 0; i < size; i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < size ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= size ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A page that evaluates the models' generated GLSL ES with exact filtering and float tables at side^2 pairs,
/// in WebGL2, and leaves the largest relative error of each, divided by how much projections cancel, in
/// data-result of its body.
inline std::string webgl_page(std::span<const ModelCase> models, int side) {
  const auto pairs = corner_and_random_pairs(side * side);
  const auto single = [](double x) { return static_cast<float>(x); };
  std::vector<float> wi, wo;
  for (const auto& pair : pairs) {
    wi.insert(wi.end(), {single(pair.wi.x), single(pair.wi.y), single(pair.wi.z), 1});
    wo.insert(wo.end(), {single(pair.wo.x), single(pair.wo.y), single(pair.wo.z), 1});
  }
  std::string text =
      fmt::format("<!DOCTYPE html><body><script>const side = {}, pairs = {{wi: '{}', wo: '{}'}}, models = [",
                  side, base64_floats(wi), base64_floats(wo));
  for (const ModelCase& model : models) {
    const FactoredBrdf brdf = smooth_model(model);
    const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl_es, ShaderFilter::exact, "m"});
    text += "{shader: `" + shader.text + "`, textures: [";
    for (std::size_t i = 0; i < brdf.tables().size(); ++i) {
      const Table& table = brdf.tables()[i];
      std::vector<float> rgba;
      for (std::size_t k = 0; k < table.layout.node_count(); ++k)
        for (std::size_t c = 0; c < 4; ++c)
          rgba.push_back(table.channels == 1 ? table.values[k] : c == 3 ? 1 : table.values[3 * k + c]);
      text += fmt::format("{{name: '{}', width: {}, height: {}, rgba: '{}'}},", shader.textures[i],
                          table.layout.width, table.layout.height, base64_floats(rgba));
    }
    std::vector<float> truth, lenience;
    for (const auto& [a, b] : pairs) {
      double f[3];
      brdf.eval(a, b, std::span(f).first(static_cast<std::size_t>(brdf.channels())));
      for (int c = 0; c < 3; ++c) truth.push_back(single(f[brdf.channels() == 1 ? 0 : c]));
      lenience.push_back(single(1 / cancellation(brdf, a, b)));
    }
    text += fmt::format("], truth: '{}', lenience: '{}'}},", base64_floats(truth), base64_floats(lenience));
  }
  return text + "];" + kWebGlRun + "</script></body>";
}

/// What Chromium finds for the page, written into `folder`: an error a model; empty where it does not run.
inline std::vector<double> run_webgl(std::span<const ModelCase> models, int side,
                                     const std::filesystem::path& folder) {
  std::ofstream(folder / "page.html") << webgl_page(models, side);
  const int code = std::system(
      fmt::format(
          "timeout 300 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
          "--enable-unsafe-swiftshader --user-data-dir={0}/profile --virtual-time-budget=5000 --dump-dom "
          "file://{0}/page.html > {0}/dom 2> {0}/said",
          folder.string())
          .c_str());
  if (code != 0) return {};
  std::ostringstream dom;
  dom << std::ifstream(folder / "dom").rdbuf();
  const std::string text = dom.str(), mark = "data-result=\"";
  const auto at = text.find(mark);
  if (at == text.npos) return {};
  std::istringstream results(text.substr(at + mark.size()));
  std::vector<double> worst;
  for (double value; worst.size() < models.size() && results >> value;) worst.push_back(value);
  return worst;
}

}  // namespace burnish
