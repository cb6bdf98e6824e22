// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/shaders/specular_shader.h>
#include <burnish/testing/compilers.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

SpecularModel model_of(PowerMethod method, bool half_vector) {
  return *specular_model(
      parse_analytic(half_vector ? "blinn_phong:exponent=60,kd=0.2/0.1/0" : "phong:exponent=30,ks=0.5/0.6/1"),
      method);
}

// Every member with both cosines.
std::vector<std::pair<std::string, SpecularModel>> models() {
  std::vector<std::pair<std::string, SpecularModel>> all;
  for (const PowerInfo& info : power_methods())
    for (const bool half_vector : {false, true}) {
      std::string name = fmt::format("{}{}", half_vector ? "blinn_" : "phong_", info.name);
      all.emplace_back(name, model_of(info.method, half_vector));
    }
  return all;
}

TEST(SpecularShader, TheExactMemberIsTheAnalyticModel) {
  for (const char* spec : {"phong:exponent=30,ks=0.5/0.6/1", "phong_normalized", "blinn_phong:kd=0.1/0.2/0.3",
                           "blinn_phong_normalized:exponent=200"}) {
    const AnalyticBrdf brdf = parse_analytic(spec);
    const SpecularModel exact = *specular_model(brdf, PowerMethod::exact);
    const SpecularModel cubic = *specular_model(brdf, PowerMethod::cubic2);
    for (const auto& [wi, wo] : corner_and_random_pairs(2000)) {
      double f[3];
      brdf.eval(wi, wo, f);
      EXPECT_NEAR(exact.eval(wi, wo).g, f[1], 1e-12 * (1 + f[1])) << spec;
      EXPECT_NEAR(cubic.eval(wi, wo).r, f[0], cubic.bound() + 1e-12) << spec;
    }
  }
  EXPECT_FALSE(specular_model(parse_analytic("ggx"), PowerMethod::exact));
}

TEST(SpecularShader, CppAgreesWithTheDefinition) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const TemporaryFolder folder("specular");
  std::string program = "#include <stdio.h>\n", calls;
  const auto all = models();
  for (const auto& [name, model] : all) {
    program += generate_shader(model, ShaderLanguage::cpp, name).text;
    calls += fmt::format("    put(burnish_{}(wi, wo));\n", name);
  }
  program +=
      "using namespace burnish_shader;\n"
      "static void put(vec3 f) { fwrite(&f, 4, 3, stdout); }\n"
      "int main() {\n  float w[6];\n  while (fread(w, 4, 6, stdin) == 6) {\n"
      "    const vec3 wi(w[0], w[1], w[2]), wo(w[3], w[4], w[5]);\n" +
      calls + "  }\n}\n";
  write(folder.path / "main.cpp", program);
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(runs(fmt::format("c++ -std=c++17 -O1 -Wall -Wextra -Werror {0}.cpp -o {0}", binary),
                   folder.path / "log"));
  const auto pairs = corner_and_random_pairs(1000);
  std::string bytes;
  for (const auto& [wi, wo] : pairs)
    for (const double x : {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}) {
      const auto single = static_cast<float>(x);
      bytes.append(reinterpret_cast<const char*>(&single), 4);
    }
  write(folder.path / "pairs", bytes);
  ASSERT_TRUE(
      runs(fmt::format("{0} < {1}/pairs > {1}/values", binary, folder.path.string()), folder.path / "log"));
  std::ifstream values(folder.path / "values", std::ios::binary);
  for (const auto& [wi, wo] : pairs)
    for (const auto& [name, model] : all) {
      float found[3];
      ASSERT_TRUE(values.read(reinterpret_cast<char*>(found), sizeof found));
      const Rgb expected = model.eval(wi, wo);
      // a cosine is 2^-23 off, a power of it `exponent` times that; the raw parabola reaches -200
      const double rounding = 1e-6 * model.exponent * (model.method == PowerMethod::quadratic_raw ? 20 : 1);
      EXPECT_NEAR(found[0], expected.r, rounding * model.height.r) << name;
      EXPECT_NEAR(found[2], expected.b, rounding * model.height.b) << name;
    }
}

TEST(SpecularShader, CostsWhatItSaysItCosts) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const TemporaryFolder folder("specular");
  std::string program = kCounting, calls, expected;
  for (const bool half_vector : {false, true}) {
    const std::string name = half_vector ? "blinn" : "phong";
    const Shader shader = generate_shader(model_of(PowerMethod::w8, half_vector), ShaderLanguage::cpp, name);
    program += shader.text;
    calls += fmt::format(
        "  operations = divisions = roots = powers = 0;\n"
        "  burnish_shader::burnish_{}({{0.6, 0.0, 0.8}}, {{0.0, 0.6, 0.8}});\n"
        "  printf(\"%d %d %d\\n\", operations, divisions, roots);\n",
        name);
    expected += fmt::format("{} {} {}\n", shader.cost.operations, shader.cost.divisions, shader.cost.roots);
  }
  write(folder.path / "main.cpp", program + "int main() {\n" + calls + "}\n");
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(runs(fmt::format("c++ -std=c++17 {0}.cpp -o {0} && {0}", binary), folder.path / "log"));
  EXPECT_EQ(read(folder.path / "log"), expected);
}

class SpecularCompilers : public testing::TestWithParam<Checked> {};

TEST_P(SpecularCompilers, AcceptEveryMember) {
  const Checked& checked = GetParam();
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool(checked.tool)) GTEST_SKIP() << "no " << checked.tool;
  const TemporaryFolder folder("specular");
  std::string files;
  for (const auto& [name, model] : models()) {
    const fs::path file = folder.path / fmt::format("{}.{}", name, checked.extension);
    write(file, checked.before + generate_shader(model, checked.language, name).text +
                    fmt::format(fmt::runtime(checked.main), name));
    files += " " + file.string();
  }
  EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), files), folder.path / "log"));
}

INSTANTIATE_TEST_SUITE_P(Languages, SpecularCompilers, testing::ValuesIn(kChecked), [](const auto& test) {
  return fmt::format("{}By{}", to_string(test.param.language), test.param.tool);
});

TEST(SpecularShader, StatesItsBoundAndRefusesWhatItCannotWrite) {
  const SpecularModel model = model_of(PowerMethod::cubic2, true);
  EXPECT_THAT(generate_shader(model, ShaderLanguage::msl, "m").text,
              testing::AllOf(HasSubstr("Within"), HasSubstr("No compiler has checked")));
  EXPECT_THROW(generate_shader(model, ShaderLanguage::glsl, "a__b"), Error);
  SpecularModel low = model;
  low.exponent = 1;
  EXPECT_THROW(generate_shader(low, ShaderLanguage::glsl, "m"), Error) << "cubic2 begins at 1.5";
}

}  // namespace
}  // namespace burnish
