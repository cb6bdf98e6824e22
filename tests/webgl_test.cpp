// Generated GLSL ES in a browser: WebGL2 draws into floats, which are read back.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <burnish/factors/models_for_tests.h>
#include <burnish/shaders/shader.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr int kSide = 64;  // of the textures that hold the pairs

constexpr const char* kRun = R"(
const gl = document.createElement("canvas").getContext("webgl2");
if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("no float targets");
function texture(unit, width, height, rgba) {
  const t = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, t);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, rgba && new Float32Array(rgba));
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
    texture(2 + i, t.width, t.height, t.rgba);
    set(t.name, 2 + i);
  });
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture(15, side, side, null), 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  let worst = gl.getError() === 0 ? 0 : NaN;
  model.truth.forEach((t, i) => {
    const f = found[i + Math.floor(i / 3)];
    worst = Math.max(worst, t > 0 ? Math.abs(f / t - 1) * model.lenience[Math.floor(i / 3)] : f === 0 ? 0 : NaN);
  });
  return worst;
}
document.body.dataset.result = models.map(evaluate).join(" ");
)";

std::string page() {
  const auto pairs = corner_and_random_pairs(kSide * kSide);
  std::vector<double> wi, wo;
  for (const auto& pair : pairs) {
    wi.insert(wi.end(), {pair.wi.x, pair.wi.y, pair.wi.z, 1});
    wo.insert(wo.end(), {pair.wo.x, pair.wo.y, pair.wo.z, 1});
  }
  std::string text =
      fmt::format("<!DOCTYPE html><body><script>const side = {}, wi = [{}], wo = [{}], models = [", kSide,
                  fmt::join(wi, ","), fmt::join(wo, ","));
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl_es, ShaderFilter::exact, "m"});
    text += "{shader: `" + shader.text + "`, textures: [";
    for (std::size_t i = 0; i < brdf.tables().size(); ++i) {
      const Table& table = brdf.tables()[i];
      std::vector<float> rgba;
      for (std::size_t k = 0; k < table.layout.node_count(); ++k)
        for (std::size_t c = 0; c < 4; ++c)
          rgba.push_back(table.channels == 1 ? table.values[k] : c == 3 ? 1 : table.values[3 * k + c]);
      text += fmt::format("{{name: '{}', width: {}, height: {}, rgba: [{}]}},", shader.textures[i],
                          table.layout.width, table.layout.height, fmt::join(rgba, ","));
    }
    std::vector<double> truth, lenience;
    for (const auto& [a, b] : pairs) {
      double f[3];
      brdf.eval(a, b, std::span(f).first(static_cast<std::size_t>(brdf.channels())));
      for (int c = 0; c < 3; ++c) truth.push_back(f[brdf.channels() == 1 ? 0 : c]);
      lenience.push_back(1 / cancellation(brdf, a, b));
    }
    text += fmt::format("], truth: [{}], lenience: [{}]}},", fmt::join(truth, ","), fmt::join(lenience, ","));
  }
  return text + "];" + kRun + "</script></body>";
}

TEST(WebGl, AgreesWithTheDefinitionToOnePartIn100000) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "no chromium";
  const fs::path folder = fs::temp_directory_path() / fmt::format("burnish_webgl_{}", ::getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "page.html") << page();
  const int code = std::system(
      fmt::format(
          "timeout 60 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
          "--enable-unsafe-swiftshader --user-data-dir={0}/profile --virtual-time-budget=5000 --dump-dom "
          "file://{0}/page.html > {0}/dom 2> {0}/said",
          folder.string())
          .c_str());
  std::ostringstream dom;
  dom << std::ifstream(folder / "dom").rdbuf();
  fs::remove_all(folder);
  ASSERT_EQ(code, 0);
  const std::string text = dom.str(), mark = "data-result=\"";
  const auto at = text.find(mark);
  ASSERT_NE(at, std::string::npos);
  std::istringstream results(text.substr(at + mark.size()));
  for (const ModelCase& model : kModelCases) {
    double worst = NAN;
    ASSERT_TRUE(results >> worst) << model.name;
    EXPECT_LE(worst, 1e-5) << model.name;
    RecordProperty(model.name, fmt::format("{:.1e}", worst));
  }
}

}  // namespace
}  // namespace burnish
