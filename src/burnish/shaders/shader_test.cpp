// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/baselines/node_table.h>
#include <burnish/error.h>
#include <burnish/fitting/fit.h>
#include <burnish/formula/graph.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/shaders/shader.h>
#include <burnish/shaders/shader_formula.h>
#include <burnish/testing/compilers.h>
#include <burnish/testing/graph_values.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Shader shader_of(const ModelCase& model, ShaderLanguage language, ShaderFilter filter = ShaderFilter::exact) {
  return generate_shader(smooth_model(model), {language, filter, model.name});
}

// All models stand in one program, which reads direction pairs and writes their values.
TEST(Shader, CppAgreesWithTheDefinitionToOnePartIn100000) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const TemporaryFolder folder("shaders");
  std::string program = "#include <stdio.h>\n", calls;
  for (const ModelCase& model : kModelCases) {
    const std::string file = fmt::format("{}.h", model.name);
    write(folder.path / file, shader_of(model, ShaderLanguage::cpp).text);
    program += fmt::format("#include \"{}\"\n", file);
    calls += fmt::format(
        "    put(burnish_{0}(wi, wo));\n    put(burnish_{0}_world(n, t, turn(wi), turn(wo)));\n", model.name);
  }
  // The world frame is the local one with its axes exchanged, so it gives the same numbers.
  program +=
      "using namespace burnish_shader;\n"
      "static void put(vec3 f) { fwrite(&f, 4, 3, stdout); }\n"
      "static vec3 turn(vec3 w) { return vec3(w.y, w.z, w.x); }\n"
      "int main() {\n  const vec3 n = turn(vec3(0, 0, 1)), t = turn(vec3(1, 0, 0));\n  float w[6];\n"
      "  while (fread(w, 4, 6, stdin) == 6) {\n"
      "    const vec3 wi(w[0], w[1], w[2]), wo(w[3], w[4], w[5]);\n" +
      calls + "  }\n}\n";
  write(folder.path / "main.cpp", program);
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(
      runs(fmt::format("c++ -std=c++17 -O1 -Wall -Wextra -Wdouble-promotion -Werror {0}.cpp -o {0}", binary),
           folder.path / "log"));
  const auto pairs = corner_and_random_pairs(4000);
  {
    std::ofstream in(folder.path / "pairs", std::ios::binary);
    for (const auto& [wi, wo] : pairs)
      for (const double x : {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}) {
        const auto single = static_cast<float>(x);
        in.write(reinterpret_cast<const char*>(&single), 4);
      }
  }
  ASSERT_TRUE(
      runs(fmt::format("{0} < {1}/pairs > {1}/values", binary, folder.path.string()), folder.path / "log"));
  std::ifstream values(folder.path / "values", std::ios::binary);
  std::vector<FactoredBrdf> brdfs;
  for (const ModelCase& model : kModelCases) brdfs.push_back(smooth_model(model));
  for (const auto& [wi, wo] : pairs)
    for (std::size_t m = 0; m < brdfs.size(); ++m) {
      float found[6];
      ASSERT_TRUE(values.read(reinterpret_cast<char*>(found), sizeof found));
      double truth[3];
      brdfs[m].eval(wi, wo, std::span(truth).first(brdfs[m].channels()));
      const bool lit = wi.z > 0 && wo.z > 0;
      for (int c = 0; c < 6; ++c) {
        const double expected = truth[brdfs[m].channels() == 1 ? 0 : c % 3];
        ASSERT_LE(std::abs(found[c] - expected),
                  lit ? 1e-5 * shader_cancellation(brdfs[m], wi, wo) * expected : 0)
            << kModelCases[m].name << " at " << wi.x << " " << wi.y << " " << wi.z << " " << wo.x << " "
            << wo.y << " " << wo.z;
      }
    }
}

TEST(Shader, CostsWhatItSaysItCosts) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const TemporaryFolder folder("shaders");
  std::string program = kCounting, calls;
  std::string expected;
  for (const ModelCase& model : kModelCases) {
    const Shader shader = shader_of(model, ShaderLanguage::cpp);
    program += shader.text;
    calls += fmt::format(
        "  operations = divisions = roots = powers = 0;\n"
        "  burnish_shader::burnish_{}({{0.6, 0.0, 0.8}}, {{0.0, 0.6, 0.8}});\n"
        "  printf(\"%d %d %d %d\\n\", operations, divisions, roots, powers);\n",
        model.name);
    const ShaderCost& cost = shader.cost;
    expected += fmt::format("{} {} {} {}\n", cost.operations, cost.divisions, cost.roots, cost.powers);
    std::size_t fetches = 0;
    for (std::size_t at = 0; (at = shader.text.find("_at(", at)) != std::string::npos; ++at) ++fetches;
    EXPECT_EQ(fetches - shader.textures.size(), static_cast<std::size_t>(cost.fetches)) << model.name;
  }
  write(folder.path / "main.cpp", program + "int main() {\n" + calls + "}\n");
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(runs(fmt::format("c++ -std=c++17 {0}.cpp -o {0} && {0}", binary), folder.path / "log"));
  std::ostringstream counted;
  counted << std::ifstream(folder.path / "log").rdbuf();
  EXPECT_EQ(counted.str(), expected);
}

class ShaderCompilers : public testing::TestWithParam<Checked> {};

TEST_P(ShaderCompilers, AcceptEveryModelWithEveryFilter) {
  const Checked& checked = GetParam();
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool(checked.tool)) GTEST_SKIP() << "no " << checked.tool;
  const TemporaryFolder folder("shaders");
  std::string files;
  for (const ModelCase& model : kModelCases)
    for (const char* how : {"exact", "hardware", "half"}) {
      const fs::path file = folder.path / fmt::format("{}_{}.{}", model.name, how, checked.extension);
      const Shader shader = generate_shader(
          smooth_model(model),
          {.language = checked.language,
           .filter = how == std::string_view("exact") ? ShaderFilter::exact : ShaderFilter::hardware,
           .name = model.name,
           .half_products = how == std::string_view("half")});
      write(file, checked.before + shader.text + fmt::format(fmt::runtime(checked.main), model.name));
      files += " " + file.string();
    }
  EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), files), folder.path / "log"));
}

INSTANTIATE_TEST_SUITE_P(Languages, ShaderCompilers, testing::ValuesIn(kChecked), [](const auto& test) {
  return fmt::format("{}By{}", to_string(test.param.language), test.param.tool);
});

TEST(Shader, ReadsATableOnceForEveryProjectionThatLobesShare) {
  const ModelCase one{"one", "pqp", {"p=8", "q=8"}, 3};
  const ModelCase two{"two", "p(wo) q(h) p(wi) + p(wo) s(h) p(wi)", {"p=8", "q=8", "s=8"}, 3};
  EXPECT_EQ(shader_of(one, ShaderLanguage::glsl, ShaderFilter::hardware).cost.fetches, 3);
  EXPECT_EQ(shader_of(two, ShaderLanguage::glsl, ShaderFilter::hardware).cost.fetches, 4);
  EXPECT_EQ(shader_of(two, ShaderLanguage::glsl).cost.fetches, 8);
}

TEST(Shader, HasTwoTexturesAtMost) {
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    std::vector<std::size_t> placed;
    for (const ShaderTexture& texture : generate_shader(brdf, {}).textures) {
      EXPECT_EQ(texture.values.size(), static_cast<std::size_t>(texture.channels * texture.width *
                                                                texture.height * std::max(texture.depth, 1)));
      for (const PlacedTable& table : texture.tables) placed.push_back(table.table);
    }
    for (const ShaderLanguage language : kShaderLanguages)
      for (const ShaderFilter filter : {ShaderFilter::exact, ShaderFilter::hardware}) {
        if (language == ShaderLanguage::cpp) continue;  // C++ has an array for each table
        EXPECT_LE(generate_shader(brdf, {language, filter}).textures.size(), 2u)
            << model.name << " " << to_string(language);
      }
    std::ranges::sort(placed);
    for (std::size_t i = 0; i < brdf.tables().size(); ++i) EXPECT_EQ(placed.at(i), i) << model.name;
  }
}

// A filtered read between a table's outermost nodes meets texels of that table alone: its nodes, and its edge again.
TEST(Shader, RepeatsTheEdgesOfTablesThatShareATexture) {
  const ModelCase model{"m",
                        "a(wo) b(h) a(wi) c(h) + d(theta_d) e(theta_h,theta_d) + f(h,d,phi_d) g(phi_d,h,d)",
                        {"a=8", "b=8x8", "c=60", "d=9,shared", "e=6x4", "f=4x3x2", "g=3x5x4"},
                        3};
  const FactoredBrdf brdf = smooth_model(model);
  const Shader shader = generate_shader(brdf, {});
  ASSERT_EQ(shader.textures.size(), 2u);
  for (const ShaderTexture& texture : shader.textures)
    for (const PlacedTable& placed : texture.tables) {
      const Table& table = brdf.tables()[placed.table];
      const std::array nodes{table.layout.width, table.layout.height, table.layout.depth},
          sides{texture.width, texture.height, std::max(texture.depth, 1)};
      const auto each = [&](std::size_t axis) {  // texels of an axis from one before the first to one beyond
        std::vector<int> all;
        const int border = nodes[axis] > 1;
        for (int i = -border; i < nodes[axis] + border; ++i)
          if (const int at = placed.first[axis] + i; at >= 0 && at < sides[axis]) all.push_back(i);
        return all;
      };
      for (const int z : each(2))
        for (const int y : each(1))
          for (const int x : each(0))
            for (std::size_t c = 0; c < texture.channels; ++c) {
              const auto node = [&](int i, std::size_t axis) { return std::clamp(i, 0, nodes[axis] - 1); };
              const int from = (node(z, 2) * nodes[1] + node(y, 1)) * nodes[0] + node(x, 0),
                        row = (placed.first[2] + z) * sides[1] + placed.first[1] + y,
                        to = (row * sides[0] + placed.first[0] + x) * texture.channels + c;
              const float value = table.values[static_cast<std::size_t>(from * table.channels +
                                                                        (table.channels == 1 ? 0 : c))];
              EXPECT_EQ(texture.values[static_cast<std::size_t>(to)], std::ldexp(value, placed.exponent));
            }
    }
}

TEST(Shader, ReadsRowsInTheirMiddleWithoutRounding) {
  const ModelCase model{"m", "a(wo) b(h) a(wi) + c(h) + d(theta_d)", {"a=8", "b=8", "c=6", "d=5"}, 3};
  const Shader shader = generate_shader(smooth_model(model), {});
  ASSERT_EQ(shader.textures.size(), 1u);
  EXPECT_EQ(shader.textures[0].height, 4);
}

TEST(Shader, MakesARowOfLinesOneDimensionalWhereAsked) {
  const auto height = [](const ModelCase& model) {
    return generate_shader(smooth_model(model), {.filter = ShaderFilter::hardware, .lines_are_1d = true})
        .textures.at(0)
        .height;
  };
  EXPECT_EQ(height(model_case("Volume")), 0);
  EXPECT_GT(height(model_case("DiskPqp")), 1);
}

// The model is a line times a volume, both spaced by the root of tan(theta_h / 2).
TEST(Shader, OfALineTimesAVolumeIsSmall) {
  const Shader shader =
      generate_shader(smooth_model(model_case("Volume")), {.filter = ShaderFilter::hardware});
  EXPECT_EQ(shader.textures.size(), 2u);
  EXPECT_EQ(shader.cost.fetches, 2);
  EXPECT_LE(shader.cost.operations, 41);
  EXPECT_LE(shader.cost.roots, 4);
  EXPECT_EQ(shader.cost.powers, 0);
}

TEST(Shader, TakesAFormatThatHoldsAllTables) {
  const auto format_of_textures = [](TableFormat first, TableFormat second) {
    const FactoredBrdf brdf = smooth_model({"m", "a(h) b(theta_d)", {"a=8", "b=6"}, 3});
    std::vector<Table> tables(brdf.tables().begin(), brdf.tables().end());
    const TableFormat formats[] = {first, second};
    for (std::size_t i = 0; i < 2; ++i) {
      tables[i].format = formats[i];
      tables[i].values = round_to_format(formats[i], 3, tables[i].values);
    }
    return generate_shader(FactoredBrdf(3, tables, {brdf.lobes().begin(), brdf.lobes().end()}), {})
        .textures.at(0)
        .format;
  };
  using enum TableFormat;
  EXPECT_EQ(format_of_textures(rgb9e5, rgb9e5), rgb9e5);
  EXPECT_EQ(format_of_textures(rgb9e5, half), half);
  EXPECT_EQ(format_of_textures(unorm8, half), single);
  EXPECT_EQ(format_of_textures(single, half), single);
}

// Returns a filtered read of texels of half floats.
std::array<double, 3> half_sample(const ShaderTexture& texture, std::span<const double> at) {
  const std::array sides{texture.width, texture.height, std::max(texture.depth, 1)};
  std::array<double, 3> sum{};
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> texel{};
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double place = std::clamp(at[k] * sides[k] - 0.5, 0.0, sides[k] - 1.0);
      const int low = std::min(static_cast<int>(place), std::max(sides[k] - 2, 0)), up = corner >> k & 1;
      weight *= up ? place - low : 1 - place + low;
      texel[k] = low + up;
    }
    if (weight == 0 || (at.size() == 2 && corner >= 4)) continue;
    const int first = ((texel[2] * sides[1] + texel[1]) * sides[0] + texel[0]) * texture.channels;
    for (int c = 0; c < 3; ++c)
      sum[static_cast<std::size_t>(c)] +=
          weight * static_cast<double>(round_to_half(
                       texture.values[static_cast<std::size_t>(first + (texture.channels == 1 ? 0 : c))]));
  }
  return sum;
}

// Returns the largest relative error of a shader with half products at values of f between `least` and 3e4.
double half_error(const FactoredBrdf& brdf, double least) {
  const ShaderFormula formula =
      shader_formula(brdf, {.filter = ShaderFilter::hardware, .half_products = true});
  Graph graph;
  const std::size_t root = graph.add(formula.value);
  GraphInputs inputs;
  inputs.round = [](double x) { return round_to_half(x); };
  inputs.sample = [&](const std::string& name, std::span<const double> at) {
    return half_sample(*std::ranges::find(formula.textures, name, &ShaderTexture::name), at);
  };
  double worst = 0;
  for (const auto& [wi, wo] : corner_and_random_pairs(2000)) {
    if (wi.z <= 0 || wo.z <= 0) continue;
    inputs.values = {{"wi", {wi.x, wi.y, wi.z}}, {"wo", {wo.x, wo.y, wo.z}}};
    const auto found = graph_values(graph, inputs)[root];
    double truth[3];
    const auto channels = brdf.channels();
    brdf.eval(wi, wo, std::span(truth).first(channels));
    for (std::size_t c = 0; c < channels; ++c)
      if (truth[c] >= least && truth[c] <= 3e4)
        worst = std::max(worst, std::abs(found[c] / truth[c] - 1) / shader_cancellation(brdf, wi, wo));
  }
  return worst;
}

TEST(HalfProducts, AreWithinOnePercent) {
  for (const ModelCase& model : kModelCases)
    EXPECT_LE(half_error(smooth_model(model), 1e-4), 0.01) << model.name;
}

// Fits have factors of 2^19 at the horizon, which make a reflectance only together.
TEST(HalfProducts, HoldTablesThatMakeUpForEachOther) {
  const ModelCase models[] = {
      {"lines", "p(wo) q(h) p(wi) r(theta_d)", {"p=64", "q=64", "r=64"}, 3},
      {"volume", "z(theta_h) g(theta_h,theta_d,phi_d)", {"z=128,power:0.5", "g=96x6x3,power:0.5"}, 3},
      {"lobes", "p(wo) q(h) p(wi) r(theta_d) + s(h) t(theta_d)", {"p=64", "q=64", "r=64", "s=8", "t=8"}, 3}};
  for (const ModelCase& model : models)
    for (const TableFormat format : {TableFormat::half, TableFormat::single, TableFormat::rgb9e5}) {
      Pcg32 random(3);
      FactoredBrdf brdf = model_of(
          model, format, random, [&](std::size_t table, const TableLayout& layout, int x, int, int c) {
            const double u = static_cast<double>(x) / (layout.width - 1);
            const bool rises = layout.shape == TableShape::volume || (table == 0 && layout.width == 64);
            return (rises ? 13 * u : -13 * u) + 0.1 * c;
          });
      EXPECT_GT(std::ranges::max(brdf.lobes()[0].scale), 1e5) << model.name;
      EXPECT_LE(half_error(brdf, 1e-3), 0.01) << model.name << " " << to_string(format);
      for (const ShaderTexture& texture : generate_shader(brdf, {}).textures)
        EXPECT_EQ(texture.values, round_to_format(texture.format, texture.channels, texture.values))
            << "no bit lost";
    }
}

// The models have volumes and lines, lobes of lines, and hemispheres.
TEST(HalfProducts, HoldWhatFitsGive) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const char* const paint = "ggx:alpha_x=0.1,alpha_y=0.1,f0=0.5/0.3/0.1,kd=0.2";
  const struct {
    const char* spec;
    Budget budget;
  } fits[] = {{paint, {.bytes = 2700}},
              {paint, {.bytes = 16 << 10, .fetches = 2}},
              {paint, {.bytes = 16 << 10, .fetches = 4}},
              {"ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3", {.bytes = 1350, .fetches = 4}}};
  for (const auto& [spec, budget] : fits) {
    const FactoredBrdf model =
        fit({spec, parse_analytic(spec), {}}, {.form = budget, .score = false}).model();
    EXPECT_LE(half_error(model, 1e-3), 0.01) << spec << " " << model_expression(model);
  }
}

TEST(HalfProducts, TakeTheHardwareFilter) {
  const FactoredBrdf brdf = smooth_model(kModelCases[0]);
  EXPECT_THROW(generate_shader(brdf, {.half_products = true}), Error);
}

// Returns the lines of a text that have a word.
std::vector<std::string> lines_with(const std::string& text, std::string_view word) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.find(word) != line.npos) found.push_back(line);
  return found;
}

TEST(ShaderPlaces, AreWrittenWhereTheyAreAskedFor) {
  const FactoredBrdf brdf = smooth_model(model_case("Volumes"));
  const auto text = [&](ShaderLanguage language, const ShaderPlaces& places) {
    return generate_shader(
               brdf, {.language = language, .filter = ShaderFilter::hardware, .name = "m", .places = places})
        .text;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(lines_with(text(ShaderLanguage::glsl, {}), "uniform "),
              ElementsAre("uniform sampler2D burnish_m_tables;", "uniform sampler3D burnish_m_volumes;"));
  EXPECT_THAT(lines_with(text(ShaderLanguage::glsl, {.binding = 3}), "uniform "),
              ElementsAre("layout(binding = 3) uniform sampler2D burnish_m_tables;",
                          "layout(binding = 4) uniform sampler3D burnish_m_volumes;"));
  EXPECT_THAT(lines_with(text(ShaderLanguage::glsl, {.set = 2}), "uniform "),
              ElementsAre("layout(set = 2, binding = 0) uniform sampler2D burnish_m_tables;",
                          "layout(set = 2, binding = 1) uniform sampler3D burnish_m_volumes;"));
  EXPECT_THAT(lines_with(text(ShaderLanguage::hlsl, {.binding = 3, .space = 1}), "register"),
              ElementsAre("Texture2D<float4> burnish_m_tables : register(t3, space1);",
                          "SamplerState burnish_m_tables_sampler : register(s3, space1);",
                          "Texture3D<float4> burnish_m_volumes : register(t4, space1);",
                          "SamplerState burnish_m_volumes_sampler : register(s4, space1);"));
  EXPECT_THAT(lines_with(text(ShaderLanguage::wgsl, {.binding = 3, .set = 1}), "@group"),
              ElementsAre("@group(1) @binding(3) var burnish_m_tables: texture_2d<f32>;",
                          "@group(1) @binding(4) var burnish_m_tables_sampler: sampler;",
                          "@group(1) @binding(5) var burnish_m_volumes: texture_3d<f32>;",
                          "@group(1) @binding(6) var burnish_m_volumes_sampler: sampler;"));
  EXPECT_THAT(lines_with(text(ShaderLanguage::slang, {.binding = 3, .set = 1}), "binding"),
              ElementsAre("[[vk::binding(3, 1)]] Texture2D<float4> burnish_m_tables;",
                          "[[vk::binding(4, 1)]] SamplerState burnish_m_tables_sampler;",
                          "[[vk::binding(5, 1)]] Texture3D<float4> burnish_m_volumes;",
                          "[[vk::binding(6, 1)]] SamplerState burnish_m_volumes_sampler;"));
  for (const ShaderLanguage language : {ShaderLanguage::glsl_es, ShaderLanguage::msl})
    EXPECT_EQ(text(language, {.binding = 3, .set = 1, .space = 2}), text(language, {}));
  for (const ShaderPlaces& places :
       {ShaderPlaces{.binding = -1}, ShaderPlaces{.set = -1}, ShaderPlaces{.space = -1}})
    EXPECT_THROW(text(ShaderLanguage::glsl, places), Error);
}

// The files of two materials are joined as a user joins them: a line for the compiler, one file, then the other.
TEST(ShaderPlaces, PutSeveralMaterialsIntoOneModule) {
  BURNISH_SKIP_WHERE_SANITIZED();
  int compiled = 0;
  for (const Checked& checked : kChecked) {
    if (!has_tool(checked.tool)) continue;
    const TemporaryFolder folder("module");
    std::string text = checked.before;
    for (const int number : {0, 1}) {
      const ShaderOptions options{.language = checked.language,
                                  .filter = ShaderFilter::hardware,
                                  .name = number == 0 ? "one" : "two",
                                  .half_products = true,
                                  .places = {.binding = 4 * number},
                                  .appended = number == 1};
      text += generate_shader(smooth_model(model_case("Volumes")), options).text;
    }
    text += fmt::format(fmt::runtime(checked.main), "two");
    const fs::path file = folder.path / fmt::format("module.{}", checked.extension);
    write(file, text);
    EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), " " + file.string()), folder.path / "log"));
    EXPECT_LE(lines_with(text, "enable ").size(), 1u);
    ++compiled;
  }
  if (compiled == 0) GTEST_SKIP() << "no compiler of shaders";
}

TEST(Shader, LeavesThePrecisionOfOtherSamplersAlone) {
  const FactoredBrdf brdf = smooth_model(model_case("Volumes"));
  for (const bool half : {false, true}) {
    const std::string text = generate_shader(brdf, {.language = ShaderLanguage::glsl_es,
                                                    .filter = ShaderFilter::hardware,
                                                    .name = "m",
                                                    .half_products = half})
                                 .text;
    EXPECT_THAT(lines_with(text, "precision "),
                ::testing::ElementsAre("precision highp float;", "precision highp int;"));
    EXPECT_THAT(text, HasSubstr(half ? "uniform mediump sampler3D burnish_m_volumes;"
                                     : "uniform highp sampler3D burnish_m_volumes;"));
  }
}

TEST(Shader, SaysWhatNoCompilerHasChecked) {
  EXPECT_THAT(shader_of(kModelCases[0], ShaderLanguage::msl).text, HasSubstr("No compiler has checked"));
}

TEST(Shader, KeepsHostileTableNamesOutOfCode) {
  const FactoredBrdf sane = smooth_model(kModelCases[0]);
  std::vector<Table> tables(sane.tables().begin(), sane.tables().end());
  tables[0].name = "x\n#error";
  tables[1].name = "a__b";
  const Shader shader = generate_shader(FactoredBrdf(3, tables, {sane.lobes().begin(), sane.lobes().end()}),
                                        {ShaderLanguage::cpp, ShaderFilter::exact, "m"});
  EXPECT_THAT(shader.text, testing::Not(HasSubstr("\n#error")));
  EXPECT_EQ(shader.textures[0].name, "burnish_m_table0");
  EXPECT_EQ(shader.textures[1].name, "burnish_m_table1");
}

TEST(Shader, RefusesWhatItCannotWrite) {
  const FactoredBrdf brdf = smooth_model(kModelCases[0]);
  for (const char* name : {"", "1a", "a b", "a__b", "a_", "_a", "a;"})
    EXPECT_THROW(generate_shader(brdf, {.name = name}), Error) << name;
  EXPECT_THROW(generate_shader(brdf, {ShaderLanguage::cpp, ShaderFilter::hardware, "m"}), Error);
  EXPECT_THROW(shader_of({"m", "pqp", {"p=4", "q=4"}, 4}, ShaderLanguage::glsl), Error);
  EXPECT_THROW(generate_shader(brdf, {.lines_are_1d = true}), Error);
  EXPECT_THROW(generate_shader(brdf, {.language = ShaderLanguage::wgsl, .textures_are_arguments = true}),
               Error);
}

TEST(SplitShader, PartsWhatNeedsTheViewAloneAndAddsNothing) {
  for (const ModelCase& model : kModelCases)
    for (const ShaderFilter filter : {ShaderFilter::exact, ShaderFilter::hardware}) {
      const FactoredBrdf brdf = smooth_model(model);
      const SplitShader split = split_shader(brdf, {ShaderLanguage::glsl, filter, "model"});
      EXPECT_EQ(split.view.find("wi"), std::string::npos) << split.view;
      ShaderCost sum = split.view_cost;
      sum += split.light_cost;
      EXPECT_EQ(sum, generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"}).cost);
    }
  const FactoredBrdf disks = smooth_model(kModelCases[1]);
  const SplitShader split = split_shader(disks, {ShaderLanguage::glsl, ShaderFilter::hardware, "model"});
  EXPECT_EQ(split.view_cost.fetches, 1) << "p(wo)";
  EXPECT_EQ(split.light_cost.fetches, 2) << "q(h) and p(wi)";
  EXPECT_THROW(split_shader(disks, {ShaderLanguage::hlsl, ShaderFilter::exact, "model"}), Error);
}

}  // namespace
}  // namespace burnish
