// SPDX-License-Identifier: Apache-2.0
// OpenPBR against the shader that MaterialX generates for open_pbr_surface and against our own, run on the OpenGL at
// hand.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/math/random.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/render/gl/gl_function.h>
#include <burnish/shaders/openpbr_shader.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/openpbr_materials.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

// One directional light and no environment; every input a uniform. Then what is a fragment's becomes a function's:
// without an environment the generator forgets one uniform, and derivatives are of fragments alone.
constexpr const char* kGenerate = R"(
import re, sys
import MaterialX as mx, MaterialX.PyMaterialXGenShader as generation, MaterialX.PyMaterialXGenGlsl as glsl
path = mx.getDefaultDataSearchPath()
library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), path, library)
document = mx.createDocument()
document.importLibrary(library)
material = document.addMaterialNode('m', document.addNode('open_pbr_surface', 's', 'surfaceshader'))
generator = glsl.GlslShaderGenerator.create()
context = generation.GenContext(generator)
context.registerSourceCodeSearchPath(path)
options = context.getOptions()
options.hwMaxActiveLightSources = 1
options.hwSpecularEnvironmentMethod = generation.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_NONE
options.shaderInterfaceType = generation.ShaderInterfaceType.SHADER_INTERFACE_COMPLETE
light = document.getNodeDef('ND_directional_light')
generation.HwShaderGenerator.bindLightShader(light, 1, context)
text = generator.generate('m', material, context).getSourceCode('pixel')
missing = '' if 'bool u_refractionTwoSided' in text else 'bool u_refractionTwoSided = false;\n'
for old, new in [(r'#version [^\n]*\n', '#define fwidth(x) vec3(1.0)\n' + missing), (r'\nuniform ', '\n'),
                 (r'\nin VertexData\n(\{[^}]*\}) vd;', r'\nstruct VertexData \1;\nVertexData vd;'),
                 (r'\nout vec4 out1;', '\nvec4 out1;'), (r'void main\(\)', 'void shade()')]:
    text = re.sub(old, new, text)
open(sys.argv[1], 'w').write(text)
)";

constexpr std::size_t kNumbers = 31;  // of the inputs, colours having three and the tangent two

// The interpreter that has MaterialX; empty if there is none.
std::string python() {
  std::vector<std::string> candidates = {BURNISH_VENV "/bin/python", "python3"};
  if (const char* given = std::getenv("BURNISH_PYTHON")) candidates = {given};
  for (const std::string& candidate : candidates)
    if (run(candidate + " -c 'import MaterialX; assert MaterialX.__version__.startswith(\"1.39\")'").status ==
        0)
      return candidate;
  return {};
}

// The fragment shader as a function of a light, a viewer and the numbers of a material, one after another.
std::string as_function(std::string text) {
  text += fmt::format(
      "layout(std430, binding = 2) readonly buffer Numbers {{ float numbers[]; }};\n"
      "vec3 reflected(vec3 wi, vec3 wo) {{\n"
      "  uint at = {}u * gl_GlobalInvocationID.x;\n",
      kNumbers);
  std::size_t k = 0;
  for (const OpenPbrInput& input : kOpenPbrInputs) {
    if (input.name == "geometry_tangent") continue;
    const bool color = std::holds_alternative<Rgb OpenPbrParameters::*>(input.member);
    text += fmt::format("  s_{} = ", input.name);
    text += color ? fmt::format("vec3(numbers[at + {}u], numbers[at + {}u], numbers[at + {}u]);\n", k, k + 1,
                                k + 2)
                  : fmt::format("numbers[at + {}u];\n", k);
    k += color ? 3 : 1;
  }
  text += fmt::format("  vd.tangentWorld = vec3(numbers[at + {}u], numbers[at + {}u], 0.0);\n", k, k + 1);
  return text + R"(
  vd.normalWorld = vec3(0.0, 0.0, 1.0);
  vd.positionWorld = vec3(0.0);
  u_viewPosition = wo;
  u_numActiveLightSources = 1;
  u_lightData[0].type = 1;
  u_lightData[0].direction = -wi;
  u_lightData[0].color = vec3(1.0);
  u_lightData[0].intensity = 1.0;
  shade();
  return out1.rgb / wi.z;
}
)";
}

void append_numbers(const OpenPbrParameters& p, std::vector<float>& numbers) {
  for (const OpenPbrInput& input : kOpenPbrInputs) {
    if (input.name == "geometry_tangent") continue;
    if (const auto* number = std::get_if<double OpenPbrParameters::*>(&input.member)) {
      numbers.push_back(static_cast<float>(p.*(*number)));
    } else {
      const Rgb color = p.*std::get<Rgb OpenPbrParameters::*>(input.member);
      for (const double value : {color.r, color.g, color.b}) numbers.push_back(static_cast<float>(value));
    }
  }
  const double tangent = radians(p.geometry_tangent);
  for (const double value : {std::cos(tangent), std::sin(tangent)})
    numbers.push_back(static_cast<float>(value));
}

// The direction of floats that a shader gets. It is not normalized again in double: at a sharp highlight, where wi and
// wo nearly cancel, what that changes is wider than the highlight, while their sum is exact in floats.
Vec3 as_floats(Vec3 w, float (&v)[3]) {
  v[0] = static_cast<float>(w.x);
  v[1] = static_cast<float>(w.y);
  v[2] = static_cast<float>(w.z);
  return {v[0], v[1], v[2]};
}

// The second arguments as the OpenGL at hand normalizes them, which MaterialX's shader does with its viewer.
std::vector<Vec3> normalized_by_gl(const std::vector<GlVectors>& calls) {
  const std::vector<float> found =
      GlFunction("vec3 normalized(vec3 a, vec3 b) { return normalize(b); }\n", "normalized").call(calls);
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < calls.size(); ++i)
    directions.push_back({found[3 * i], found[3 * i + 1], found[3 * i + 2]});
  return directions;
}

// The largest difference of the channels relative to ours.
double relative_error(const OpenPbr& material, const DirectionPair& pair, std::span<const float> found) {
  std::array<double, 3> f;
  material.eval(pair.wi, pair.wo, f);
  double error = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double theirs = std::max(0.0, static_cast<double>(found[c]));
    error = std::max(error, std::abs(f[c] - theirs) / std::max(theirs, 1e-6));
  }
  return error;
}

// Sorted errors: at(share) is the error that this share of them does not exceed.
class Errors {
 public:
  explicit Errors(std::vector<double> errors) : sorted_(std::move(errors)) { std::ranges::sort(sorted_); }

  double at(double share) const {
    return sorted_[static_cast<std::size_t>(share * static_cast<double>(sorted_.size() - 1))];
  }
  void record() const {
    const double sum = std::accumulate(sorted_.begin(), sorted_.end(), 0.0);
    testing::Test::RecordProperty(
        "errors",
        fmt::format("mean {:.2e}, median {:.2e}, 99 % {:.2e}, 99.9 % {:.2e}, most {:.2e}",
                    sum / static_cast<double>(sorted_.size()), at(0.5), at(0.99), at(0.999), at(1)));
  }

 private:
  std::vector<double> sorted_;
};

TEST(GlOpenPbr, IsMaterialXsShader) {
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  const std::string interpreter = python();
  if (interpreter.empty()) GTEST_SKIP() << "MaterialX 1.39 is not installed in build/venv (make python does)";
  const TemporaryFolder folder("openpbr");
  const std::string script = (folder.path / "generate.py").string(),
                    shader = (folder.path / "shader").string();
  write(script, kGenerate);
  const Outcome generated = run(fmt::format("{} {} {}", interpreter, script, shader));
  ASSERT_EQ(generated.status, 0) << generated.output;

  constexpr std::size_t kCount = 100'000;
  Pcg32 random(20);
  std::vector<OpenPbrParameters> materials(kCount);
  std::vector<GlVectors> calls(kCount);
  std::vector<DirectionPair> pairs(kCount);
  std::vector<float> numbers;
  for (std::size_t i = 0; i < kCount; ++i) {
    const OpenPbrParameters& p = materials[i] = draw_openpbr(random);
    const DirectionPair pair =
        draw_highlight_pair(random, i % 2 == 0 ? p.specular_roughness : p.coat_roughness);
    pairs[i] = {as_floats(pair.wi, calls[i].a), as_floats(pair.wo, calls[i].b)};
    append_numbers(p, numbers);
  }
  ASSERT_EQ(numbers.size(), kNumbers * kCount);
  const std::vector<Vec3> viewers = normalized_by_gl(calls);
  for (std::size_t i = 0; i < kCount; ++i) pairs[i].wo = viewers[i];
  GlFunction function(as_function(read(shader)), "reflected");
  function.set_numbers(numbers);
  const std::vector<float> found = function.call(calls);

  std::vector<double> all(kCount);
  for (std::size_t i = 0; i < kCount; ++i)
    all[i] = relative_error(OpenPbr(materials[i]), pairs[i], std::span(found).subspan(3 * i, 3));
  const Errors errors(std::move(all));
  errors.record();
  EXPECT_LE(errors.at(0.999), 1e-3);
  EXPECT_LE(errors.at(0.5), 1e-5);
}

TEST(GlOpenPbr, ItsShaderIsTheDefinition) {
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  constexpr std::size_t kMaterials = 24, kPairs = 5000;
  Pcg32 random(21);
  std::vector<double> all;
  for (std::size_t m = 0; m < kMaterials; ++m) {
    const OpenPbrParameters p = draw_openpbr(random);
    const OpenPbr material(p);
    std::vector<GlVectors> calls(kPairs);
    std::vector<DirectionPair> pairs(kPairs);
    for (std::size_t i = 0; i < kPairs; ++i) {
      const DirectionPair pair =
          draw_highlight_pair(random, i % 2 == 0 ? p.specular_roughness : p.coat_roughness);
      pairs[i] = {as_floats(pair.wi, calls[i].a), as_floats(pair.wo, calls[i].b)};
    }
    const Shader shader = generate_shader(material, ShaderLanguage::glsl, "m");
    const std::vector<float> found = GlFunction(shader.text, "burnish_m").call(calls);
    for (std::size_t i = 0; i < kPairs; ++i)
      all.push_back(relative_error(material, pairs[i], std::span(found).subspan(3 * i, 3)));
  }
  const Errors errors(std::move(all));
  errors.record();
  EXPECT_LE(errors.at(0.999), 1e-3);
  EXPECT_LE(errors.at(0.5), 1e-5);
}

}  // namespace
}  // namespace burnish
