// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/shaders/openpbr_shader.h>
#include <burnish/testing/compilers.h>
#include <burnish/testing/openpbr_materials.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Plain, a metal, one with every layer, and some at random.
std::vector<OpenPbrParameters> openpbr_materials() {
  std::vector<OpenPbrParameters> all(3);
  all[1].base_metalness = 1;
  all[2] = {.base_metalness = 0.4,
            .base_diffuse_roughness = 0.3,
            .specular_roughness_anisotropy = 0.5,
            .coat_weight = 0.5,
            .coat_roughness = 0.2,
            .fuzz_weight = 0.4,
            .thin_film_weight = 0.6,
            .thin_film_thickness = 0.4};
  Pcg32 random(9);
  while (all.size() < 8) all.push_back(draw_openpbr(random));
  return all;
}

// A program of all materials; `call` makes a statement of a material's name.
std::string program_of(ShaderLanguage language, const std::vector<OpenPbrParameters>& materials,
                       fmt::string_view call, std::string& calls) {
  std::string program;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const std::string name = fmt::format("m{}", m);
    program += generate_shader(OpenPbr(materials[m]), language, name).text;
    calls += fmt::format(fmt::runtime(call), name);
  }
  return program;
}

TEST(OpenPbrShader, CppAgreesWithTheDefinition) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const TemporaryFolder folder("openpbr_shader");
  const std::vector<OpenPbrParameters> materials = openpbr_materials();
  std::string calls;
  const std::string functions =
      program_of(ShaderLanguage::cpp, materials, "    put(burnish_{}(wi, wo));\n", calls);
  write(folder.path / "main.cpp", "#include <stdio.h>\n" + functions +
                                      "using namespace burnish_shader;\n"
                                      "static void put(vec3 f) { fwrite(&f, 4, 3, stdout); }\n"
                                      "int main() {\n  float w[6];\n  while (fread(w, 4, 6, stdin) == 6) {\n"
                                      "    const vec3 wi(w[0], w[1], w[2]), wo(w[3], w[4], w[5]);\n" +
                                      calls + "  }\n}\n");
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(
      runs(fmt::format("c++ -std=c++17 -O1 -Wall -Wextra -Wdouble-promotion -Werror {0}.cpp -o {0}", binary),
           folder.path / "log"));
  // highlights of every material; what is below the horizon is black
  Pcg32 random(10);
  std::vector<DirectionPair> pairs{{{0.6, 0, -0.8}, {0, 0, 1}}, {{0, 0, 1}, {0.6, 0, -0.8}}};
  while (pairs.size() < 4000)
    pairs.push_back(
        draw_highlight_pair(random, materials[pairs.size() % materials.size()].specular_roughness));
  std::string bytes;
  for (auto& [wi, wo] : pairs)
    for (Vec3* const w : {&wi, &wo}) {
      const float single[3] = {static_cast<float>(w->x), static_cast<float>(w->y), static_cast<float>(w->z)};
      bytes.append(reinterpret_cast<const char*>(single), sizeof single);
      *w = normalize({single[0], single[1], single[2]});
    }
  write(folder.path / "pairs", bytes);
  ASSERT_TRUE(
      runs(fmt::format("{0} < {1}/pairs > {1}/values", binary, folder.path.string()), folder.path / "log"));
  std::ifstream values(folder.path / "values", std::ios::binary);
  std::vector<double> errors;
  for (const auto& [wi, wo] : pairs)
    for (const OpenPbrParameters& p : materials) {
      float found[3];
      ASSERT_TRUE(values.read(reinterpret_cast<char*>(found), sizeof found));
      double f[3], error = 0;
      OpenPbr(p).eval(wi, wo, f);
      for (int c = 0; c < 3; ++c) {
        if (wi.z < 0 || wo.z < 0) {
          EXPECT_EQ(found[c], 0);
        }
        error = std::max(error, std::abs(found[c] - f[c]) / std::max(f[c], 1e-6));
      }
      errors.push_back(error);
    }
  std::ranges::sort(errors);
  EXPECT_LE(errors[errors.size() * 999 / 1000], 1e-3);
  EXPECT_LE(errors[errors.size() / 2], 1e-5);
}

// float(1.5e-3f) for 1.5e-3f, so that a type may stand in for float.
std::string with_typed_numbers(std::string_view code) {
  const auto in_word = [&](std::size_t i) {
    return i < code.size() &&
           (std::isalnum(static_cast<unsigned char>(code[i])) || code[i] == '_' || code[i] == '.');
  };
  std::string typed;
  for (std::size_t i = 0; i < code.size();) {
    std::size_t end = i;
    while (in_word(end) || (end > i && (code[end] == '-' || code[end] == '+') && code[end - 1] == 'e' &&
                            std::isdigit(static_cast<unsigned char>(code[i]))))
      ++end;
    const std::string_view word = code.substr(i, std::max<std::size_t>(1, end - i));
    const bool number = std::isdigit(static_cast<unsigned char>(word.front())) && word.back() == 'f';
    typed += number ? fmt::format("float({})", word) : std::string(word);
    i += word.size();
  }
  return typed;
}

TEST(OpenPbrShader, CostsWhatItSaysItCosts) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const TemporaryFolder folder("openpbr_shader");
  const std::vector<OpenPbrParameters> materials = openpbr_materials();
  std::string calls, expected;
  const std::string functions =
      program_of(ShaderLanguage::cpp, materials,
                 "  operations = divisions = roots = powers = 0;\n"
                 "  burnish_shader::burnish_{}({{0.6, 0.0, 0.8}}, {{0.36, 0.48, 0.8}});\n"
                 "  printf(\"%d %d %d %d\\n\", operations, divisions, roots, powers);\n",
                 calls);
  for (const OpenPbrParameters& p : materials) {
    const ShaderCost cost = generate_shader(OpenPbr(p), ShaderLanguage::cpp, "m").cost;
    EXPECT_EQ(cost.fetches, 0);
    expected += fmt::format("{} {} {} {}\n", cost.operations, cost.divisions, cost.roots, cost.powers);
  }
  // numbers between numbers count too
  write(folder.path / "main.cpp",
        kCounting + with_typed_numbers(functions) + "int main() {\n" + calls + "}\n");
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(runs(fmt::format("c++ -std=c++17 {0}.cpp -o {0} && {0}", binary), folder.path / "log"));
  EXPECT_EQ(read(folder.path / "log"), expected);
}

class OpenPbrCompilers : public testing::TestWithParam<Checked> {};

TEST_P(OpenPbrCompilers, AcceptEveryMaterial) {
  const Checked& checked = GetParam();
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool(checked.tool)) GTEST_SKIP() << "no " << checked.tool;
  const TemporaryFolder folder("openpbr_shader");
  std::string files;
  const std::vector<OpenPbrParameters> materials = openpbr_materials();
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const std::string name = fmt::format("m{}", m);
    const fs::path file = folder.path / fmt::format("{}.{}", name, checked.extension);
    write(file, checked.before + generate_shader(OpenPbr(materials[m]), checked.language, name).text +
                    fmt::format(fmt::runtime(checked.main), name));
    files += " " + file.string();
  }
  EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), files), folder.path / "log"));
}

INSTANTIATE_TEST_SUITE_P(Languages, OpenPbrCompilers, testing::ValuesIn(kChecked), [](const auto& test) {
  return fmt::format("{}By{}", to_string(test.param.language), test.param.tool);
});

TEST(OpenPbrShader, SaysWhatItIsAndRefusesWhatIsNoName) {
  const OpenPbr material(OpenPbrParameters{.coat_weight = 0.25});
  EXPECT_THAT(generate_shader(material, ShaderLanguage::msl, "m").text,
              testing::AllOf(HasSubstr("coat_weight=0.25"), HasSubstr("No compiler has checked")));
  EXPECT_THROW(generate_shader(material, ShaderLanguage::glsl, "a__b"), Error);
}

}  // namespace
}  // namespace burnish
