// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/math/random.h>
#include <burnish/render/gl/gl_evaluator.h>
#include <burnish/render/gl/gl_objects.h>
#include <burnish/shaders/sampler_shader.h>
#include <burnish/testing/compilers.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/glossy_models.h>
#include <burnish/testing/sampling.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kDrawsAView = 20'000;

// A call of a drawing function: wo and two uniform numbers.
struct Call {
  Vec3 wo;
  Point2 u;
};
// Its results: the direction with its density, the density that the other function gives, and the weight of a draw.
struct Answer {
  float x, y, z, pdf, pdf_again, weight[3];
};

// Returns kDrawsAView calls for each of kViews, in floats.
std::vector<Call> calls_of_views() {
  std::vector<Call> all;
  const auto in_float = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  for (const Vec3 wo : kViews) {
    Pcg32 random(3);
    for (int i = 0; i < kDrawsAView; ++i) {
      const double x = random.uniform(), y = random.uniform();
      all.push_back({{in_float(wo.x), in_float(wo.y), in_float(wo.z)},
                     {std::min(in_float(x), 0.9999999), std::min(in_float(y), 0.9999999)}});
    }
  }
  return all;
}

// Expects what a shader draws to be what the sampler draws, but for draws at borders of cells.
void expect_draws(const FactoredBrdf& brdf, const TabulatedSampler& sampler, const std::vector<Call>& asked,
                  const std::vector<Answer>& answers) {
  ASSERT_EQ(answers.size(), asked.size());
  std::size_t other_directions = 0, other_densities = 0, other_pdfs = 0, other_weights = 0;
  std::vector<double> f(brdf.channels());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto [wo, u] = asked[i];
    const Answer& answer = answers[i];
    const Vec3 wi{answer.x, answer.y, answer.z};
    const DrawnDirection drawn = sampler.sample_wi(wo, u);
    other_directions += length(wi - drawn.wi) > 1e-4;
    other_densities += std::abs(answer.pdf - drawn.pdf) > 1e-3 * drawn.pdf;
    const double pdf = sampler.pdf(wi, wo);
    other_pdfs += std::abs(answer.pdf_again - pdf) > 1e-3 * pdf;
    if (!(drawn.pdf > 0) || !(drawn.wi.z > 0)) continue;
    brdf.eval(drawn.wi, wo, f);
    for (std::size_t c = 0; c < 3; ++c) {
      const double weight = f[c % brdf.channels()] * drawn.wi.z / drawn.pdf;
      other_weights += std::abs(answer.weight[c] - weight) > 1e-3 * weight;
    }
  }
  EXPECT_LE(other_directions, asked.size() / 10000);
  EXPECT_LE(other_densities, asked.size() / 10000);
  EXPECT_LE(other_pdfs, asked.size() / 10000);
  EXPECT_LE(other_weights, 3 * asked.size() / 10000);

  // The draws have the density that the sampler says.
  for (std::size_t v = 0; v < std::size(kViews); ++v) {
    const HalfVectorBins bins{kViews[v]};
    std::vector<double> expected = bins.integrals(sampler), seen(bins.count());
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (double& e : expected) e *= kDrawsAView;
    expected.back() = std::max(1 - total, 0.0) * kDrawsAView;
    for (std::size_t i = v * kDrawsAView; i < (v + 1) * kDrawsAView; ++i)
      ++seen[bins.of({{answers[i].x, answers[i].y, answers[i].z}, answers[i].pdf})];
    EXPECT_GE(chi_square_p_value(expected, seen), 1e-3) << v;
  }
}

TEST(SamplerShader, DrawsAsTheSamplerOnOpenGl) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  const std::vector<Call> asked = calls_of_views();
  for (const ModelCase& model : kGlossyModels) {
    SCOPED_TRACE(model.name);
    const FactoredBrdf brdf = glossy_model(model);
    const TabulatedSampler sampler(brdf);
    const Shader value = generate_shader(brdf, {.name = "test"});
    const SamplerShader shader = generate_shader(sampler.tables(), ShaderLanguage::glsl, "test");
    // The third number of b says which of the results is asked for.
    GlFunction function(value.text + shader.text +
                            "vec3 asked(vec3 wo, vec3 b) {\n"
                            "  vec4 d = burnish_test_sample(wo, b.xy);\n"
                            "  if (b.z == 0.0) return d.xyz;\n"
                            "  if (b.z == 1.0) return vec3(d.w, burnish_test_pdf(d.xyz, wo), 0.0);\n"
                            "  return burnish_test(d.xyz, wo) * d.z / d.w;\n}\n",
                        "asked");
    set_textures(function, value.textures, TableFormat::single, false);
    function.set_texture(upload_of(shader.texture, TableFormat::single, false));
    std::vector<Answer> answers(asked.size());
    for (const float kind : {0.0F, 1.0F, 2.0F}) {
      std::vector<GlVectors> arguments;
      for (const auto& [wo, u] : asked)
        arguments.push_back({{static_cast<float>(wo.x), static_cast<float>(wo.y), static_cast<float>(wo.z)},
                             {static_cast<float>(u.x), static_cast<float>(u.y), kind}});
      const std::vector<float> got = function.call(arguments);
      for (std::size_t i = 0; i < answers.size(); ++i) {
        Answer& a = answers[i];
        float* const to[] = {kind == 1   ? &a.pdf
                             : kind == 2 ? &a.weight[0]
                                         : &a.x,
                             kind == 1   ? &a.pdf_again
                             : kind == 2 ? &a.weight[1]
                                         : &a.y,
                             kind == 2 ? &a.weight[2] : &a.z};
        for (std::size_t k = 0; k < (kind == 1 ? 2 : 3); ++k) *to[k] = got[3 * i + k];
      }
    }
    expect_draws(brdf, sampler, asked, answers);
  }
}

TEST(SamplerShader, DrawsAsTheSamplerInCpp) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("sampler_shader");
  // All models are one program: the first argument chooses the model.
  std::string program, choice;
  std::vector<FactoredBrdf> brdfs;
  std::vector<TabulatedSampler> samplers;
  for (const ModelCase& model : kGlossyModels) {
    const FactoredBrdf& brdf = brdfs.emplace_back(glossy_model(model));
    const TabulatedSampler& sampler = samplers.emplace_back(brdf);
    const std::string name = fmt::format("m{}", brdfs.size() - 1);
    program += generate_shader(brdf, {.language = ShaderLanguage::cpp, .name = name}).text +
               generate_shader(sampler.tables(), ShaderLanguage::cpp, name).text;
    choice += fmt::format(
        "    if (argv[1] == std::string(\"{0}\")) {{\n"
        "      const vec4 d = burnish_{0}_sample(wo, u);\n"
        "      const vec3 wi(d.x, d.y, d.z), f = (d.z / d.w) * burnish_{0}(wi, wo);\n"
        "      const float out[] = {{d.x, d.y, d.z, d.w, burnish_{0}_pdf(wi, wo), f.x, f.y, f.z}};\n"
        "      std::fwrite(out, sizeof out, 1, stdout);\n    }}\n",
        name);
  }
  write(folder.path / "draw.cpp",
        "#include <cstdio>\n#include <string>\n" + program +
            "int main(int, char** argv) {\n  using namespace burnish_shader;\n  float in[5];\n"
            "  while (std::fread(in, sizeof in, 1, stdin) == 1) {\n"
            "    const vec3 wo(in[0], in[1], in[2]);\n    const vec2 u = {in[3], in[4]};\n" +
            choice + "  }\n}\n");
  ASSERT_TRUE(runs(
      fmt::format("cd {} && c++ -std=c++17 -O1 -Wall -Wextra -Werror draw.cpp -o draw", folder.path.string()),
      folder.path / "log"));
  const std::vector<Call> asked = calls_of_views();
  std::string bytes;
  for (const auto& [wo, u] : asked)
    for (const double x : {wo.x, wo.y, wo.z, u.x, u.y}) {
      const auto single = static_cast<float>(x);
      bytes.append(reinterpret_cast<const char*>(&single), sizeof single);
    }
  write(folder.path / "in", bytes);
  for (std::size_t m = 0; m < brdfs.size(); ++m) {
    SCOPED_TRACE(kGlossyModels[m].name);
    ASSERT_TRUE(
        runs(fmt::format("cd {} && ./draw m{} < in > out", folder.path.string(), m), folder.path / "log"));
    const std::string out = read(folder.path / "out");
    ASSERT_EQ(out.size(), asked.size() * sizeof(Answer));
    std::vector<Answer> answers(asked.size());
    std::memcpy(answers.data(), out.data(), out.size());
    expect_draws(brdfs[m], samplers[m], asked, answers);
  }
}

// Returns a main function that calls all four functions.
std::string main_of(ShaderLanguage language) {
  constexpr std::string_view kCalls =
      "burnish_test_sample(a, a.xy) + burnish_test_sample_world(a, a, a, a.xy) * burnish_test_pdf(a, a) * "
      "burnish_test_pdf_world(a, a, a, a)";
  if (language == ShaderLanguage::hlsl || language == ShaderLanguage::slang)
    return fmt::format(
        "float4 main(float4 at : SV_Position) : SV_Target {{ float3 a = at.xyz; return {}; }}\n", kCalls);
  if (language == ShaderLanguage::wgsl)
    return fmt::format(
        "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {{ let a = at.xyz; return {}; "
        "}}\n",
        kCalls);
  return fmt::format("out vec4 color;\nvoid main() {{ vec3 a = vec3(0, 0, 1); color = {}; }}\n", kCalls);
}

TEST(SamplerShader, CompilesInEveryLanguageWithACompiler) {
  const TemporaryFolder folder("sampler_compiled");
  int compiled = 0;
  for (const Checked& checked : kChecked) {
    if (!has_tool(checked.tool)) continue;
    std::string files;
    for (const char* model : {"Pqp", "Disks"}) {
      const TabulatedSampler sampler(glossy_model(glossy_case(model)));
      const fs::path file =
          folder.path / fmt::format("{}_{}.{}", to_string(checked.language), model, checked.extension);
      write(file, checked.before + generate_shader(sampler.tables(), checked.language, "test").text +
                      main_of(checked.language));
      files += " " + file.string();
    }
    EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), files), folder.path / "log"));
    ++compiled;
  }
  if (compiled == 0) GTEST_SKIP() << "no compiler of shaders";
}

TEST(SamplerShader, HasTheSamplersNumbersInItsTexture) {
  const TabulatedSampler sampler(glossy_model(glossy_case("Pqp")));
  const SamplerTables tables = sampler.tables();
  const ShaderTexture texture = generate_shader(tables, ShaderLanguage::wgsl, "test").texture;
  EXPECT_EQ(texture.channels, 1u);
  EXPECT_EQ(texture.values.size(), static_cast<std::size_t>(texture.width * texture.height));
  const auto cells = (tables.row_edges.size() + 63) / 64 * 64;
  for (std::size_t i = 0; i < tables.row_edges.size(); ++i) EXPECT_EQ(texture.values[i], tables.row_edges[i]);
  for (std::size_t i = 0; i < tables.cell_edges.size(); ++i)
    EXPECT_EQ(texture.values[cells + i], tables.cell_edges[i]);
  EXPECT_TRUE(generate_shader(tables, ShaderLanguage::cpp, "test").texture.values.empty());
}

TEST(SamplerShader, CountsItsPlaceFromTheBindingThatIsAskedFor) {
  const TabulatedSampler sampler(glossy_model(glossy_case("Pqp")));
  const auto text = [&](ShaderLanguage language, const ShaderPlaces& places) {
    return generate_shader(sampler.tables(), language, "test", places).text;
  };
  EXPECT_THAT(text(ShaderLanguage::glsl, {.binding = 2, .set = 1}),
              HasSubstr("layout(set = 1, binding = 11) uniform sampler2D burnish_test_sample_tables;"));
  EXPECT_THAT(text(ShaderLanguage::wgsl, {}),
              HasSubstr("@group(0) @binding(9) var burnish_test_sample_tables: texture_2d<f32>;"));
  EXPECT_THROW(text(ShaderLanguage::glsl, {.binding = -1}), Error);
  EXPECT_THROW(generate_shader(sampler.tables(), ShaderLanguage::glsl, "a b"), Error);
}

}  // namespace
}  // namespace burnish
