// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/power/code.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// The emitted functions of all members, each made unique, run by one C program over a grid of cosines.
TEST(PowerCode, EmittedCEqualsTheDefinition) {
  if (!has_tool("cc")) GTEST_SKIP() << "no C compiler";
  const TemporaryFolder folder("code");
  constexpr double kExponents[] = {4, 21.5, 1000};
  std::string program, calls;
  int functions = 0;
  const auto add = [&](std::string code, const PowerInfo& info, const std::string& arguments) {
    const std::string name = fmt::format("power_{}", info.name), unique = fmt::format("f{}", functions++);
    code.replace(code.find(name + "("), name.size(), unique);
    for (std::size_t at; (at = code.find("power_exponent_of")) != std::string::npos;)
      code.replace(at, 5, unique);
    program += code;
    calls += fmt::format("    printf(\"%.9g\\n\", {}({}));\n", unique, arguments);
  };
  for (const PowerInfo& info : power_methods()) {
    for (double e : kExponents) {
      add(power_code(info.method, {"c", e, false}), info, "c");
      add(power_code(info.method, {"c", {}, false}), info, fmt::format("c, (float){:.9g}", e));
      add(power_code(info.method, {"c", e, true}), info, "c");
    }
  }
  program =
      "#include <stdio.h>\n" + program +
      "int main(void) {\n  for (int i = 0; i <= 64; ++i) {\n    float c = 1 - (i / 64.0f) * (i / 64.0f);\n" +
      calls + "  }\n}\n";
  write(folder.path / "power.c", program);
  const std::string binary = (folder.path / "power").string();
  ASSERT_EQ(std::system(fmt::format("cc -std=c99 -Wall -Werror -O0 {}.c -o {} -lm", binary, binary).c_str()),
            0);
  std::FILE* pipe = popen(binary.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  for (int i = 0; i <= 64; ++i) {
    const double c = 1 - (i / 64.0) * (i / 64.0);
    for (const PowerInfo& info : power_methods())
      for (double e : kExponents) {
        const double expected = power(info.method, c, e), scale = power_normalization(info.method, e);
        const double size = info.method == PowerMethod::quadratic_raw ? 1 + e * (1 - c) : 1;
        for (int variant = 0; variant < 3; ++variant) {
          double found = 0;
          ASSERT_EQ(std::fscanf(pipe, "%lf", &found), 1);
          // With the exponent as argument its coefficients are floats too.
          const double rounding = variant == 1 ? 2e-5 : 4e-6;
          EXPECT_NEAR(found, variant == 2 ? expected * scale : expected, rounding * size)
              << info.name << " c " << c << " e " << e << " variant " << variant;
        }
      }
  }
  EXPECT_EQ(pclose(pipe), 0);
}

class EmittedShaders : public testing::TestWithParam<std::array<const char*, 4>> {};

TEST_P(EmittedShaders, AreAcceptedByTheirCompiler) {
  const auto [language, tool, extension, command] = GetParam();
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool(tool)) GTEST_SKIP() << "no " << tool;
  const TemporaryFolder folder("code");
  for (const bool constant : {true, false}) {
    std::string functions, calls;
    for (const PowerInfo& info : power_methods()) {
      functions +=
          power_code(info.method, {language, constant ? std::optional(37.5) : std::nullopt, constant});
      calls += fmt::format(" + power_{}({})", info.name, constant ? "0.5" : "0.5, 20.0");
    }
    if (std::string(language).starts_with("glsl"))
      functions = fmt::format(
          "#version {}\nlayout(location = 0) out float color;\n{}void main() {{ color = 0.0{}; }}\n",
          std::string(language) == "glsl" ? "450" : "300 es\nprecision highp float;", functions, calls);
    else if (std::string(language) == "hlsl" || std::string(language) == "slang")
      functions += fmt::format("float4 main() : SV_Target {{ return 0.0{}; }}\n", calls);
    const fs::path file = folder.path / fmt::format("power{}.{}", constant, extension);
    write(file, functions);
    const std::string run = fmt::format(fmt::runtime(command), file.string(), folder.path.string());
    EXPECT_EQ(std::system((run + " >/dev/null 2>&1").c_str()), 0) << run << "\n" << functions;
  }
}

INSTANTIATE_TEST_SUITE_P(
    PowerCode, EmittedShaders,
    testing::Values(
        std::array{"glsl", "glslangValidator", "frag", "glslangValidator {0}"},
        std::array{"glsl_es", "glslangValidator", "frag", "glslangValidator {0}"},
        std::array{"hlsl", "glslangValidator", "frag", "glslangValidator -D -e main -V {0} -o {1}/out.spv"},
        std::array{"slang", "glslangValidator", "frag", "glslangValidator -D -e main -V {0} -o {1}/out.spv"},
        std::array{"wgsl", "naga", "wgsl", "naga {0}"},
        std::array{"rust", "rustc", "rs", "rustc --crate-type lib --emit metadata --out-dir {1} {0}"}),
    [](const auto& shader) { return std::string(shader.param[0]); });

TEST(PowerCode, StatesItsOriginRangeAndBound) {
  const std::string code = power_code(PowerMethod::cubic2, {"glsl", {}, false});
  EXPECT_EQ(code.find("// Generated by burnish specular code"), 0u);
  EXPECT_THAT(code, HasSubstr("e in [1.5, 1024]"));
  EXPECT_THAT(code, HasSubstr("0.0035"));
  EXPECT_THAT(power_code(PowerMethod::w8, {"msl", 30, false}), HasSubstr("No compiler has checked"));
}

TEST(PowerCode, RefusesWhatItCannotWrite) {
  EXPECT_THROW(power_code(PowerMethod::w8, {"cobol", 10, false}), Error);
  EXPECT_THROW(power_code(PowerMethod::cubic4, {"c", 2, false}), Error);
  EXPECT_THROW(power_code(PowerMethod::w8, {"c", {}, true}), Error);
}

TEST(QuadraticTable, HoldsTheCoefficientInEveryFormat) {
  std::istringstream csv(quadratic_table("csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "exponent,a");
  int rows = 0;
  for (; std::getline(csv, line); ++rows) {
    const auto comma = line.find(',');
    EXPECT_EQ(std::stoi(line), rows + 1);
    EXPECT_EQ(std::stod(line.substr(comma + 1)), quadratic_coefficient(rows + 1));
  }
  EXPECT_EQ(rows, 1000);

  std::istringstream mem(quadratic_table("mem", 1000, 8));
  int address = 0;
  while (std::getline(mem, line)) {
    if (line[0] == '/') continue;
    const double a = address == 0 ? 0 : quadratic_coefficient(address);
    EXPECT_NEAR(std::stoi(line, nullptr, 16) / 256.0, a, 0.5 / 256);
    EXPECT_EQ(line.size(), 5u);
    ++address;
  }
  EXPECT_EQ(address, 1001);

  EXPECT_THAT(quadratic_table("c"), HasSubstr("burnish_quadratic_a[1001]"));
  EXPECT_THAT(quadratic_table("c"), HasSubstr("\n    786.438599f,\n};"));
  EXPECT_THROW(quadratic_table("xml"), Error);
  EXPECT_THROW(quadratic_table("csv", 0), Error);
  EXPECT_THROW(quadratic_table("mem", 10, 21), Error);
}

}  // namespace
}  // namespace burnish
