// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/shaders/shader.h>

namespace burnish {

/// Runs a shell command. Its output is written to `log` and, if the command fails, becomes the message.
inline ::testing::AssertionResult runs(const std::string& command, const std::filesystem::path& log) {
  if (std::system(fmt::format("({}) > {} 2>&1", command, log.string()).c_str()) == 0)
    return ::testing::AssertionSuccess();
  std::ostringstream said;
  said << std::ifstream(log).rdbuf();
  return ::testing::AssertionFailure() << command << ":\n" << said.str();
}

/// A number type that counts its operations, in place of float in the generated C++.
inline constexpr const char* kCounting = R"(
#include <math.h>
#include <stdio.h>
static int operations, divisions, roots, powers;
struct Counted {
  double v;
  Counted(double a) : v(a) {}
  explicit operator int() const { return int(v); }
  Counted operator-() const { return -v; }
  friend Counted operator+(Counted a, Counted b) { return ++operations, a.v + b.v; }
  friend Counted operator-(Counted a, Counted b) { return ++operations, a.v - b.v; }
  friend Counted operator*(Counted a, Counted b) { return ++operations, a.v * b.v; }
  friend Counted operator/(Counted a, Counted b) { return ++divisions, a.v / b.v; }
  friend bool operator<(Counted a, Counted b) { return ++operations, a.v < b.v; }
  friend bool operator>(Counted a, Counted b) { return ++operations, a.v > b.v; }
  friend bool operator<=(Counted a, Counted b) { return a.v <= b.v; }
};
static Counted sqrtf(Counted a) { return ++roots, sqrt(a.v); }
static Counted fmaxf(Counted a, Counted b) { return ++operations, a.v < b.v ? b : a; }
static Counted fabsf(Counted a) { return fabs(a.v); }
static Counted floorf(Counted a) { return ++operations, floor(a.v); }
static Counted powf(Counted a, Counted b) { return ++powers, pow(a.v, b.v); }
static Counted exp2f(Counted a) { return ++powers, exp2(a.v); }
static Counted acosf(Counted a) { return ++powers, acos(a.v); }
static Counted cosf(Counted a) { return ++powers, cos(a.v); }
#define float Counted
)";

/// A compiler of a language, the text that makes a program of a shader called {0}, and the command that runs it.
struct Checked {
  ShaderLanguage language;
  const char *tool, *extension, *before, *main, *command;
};
inline const Checked kChecked[] = {
    {ShaderLanguage::glsl, "glslangValidator", "frag", "#version 450\n",
     "out vec4 color;\nvoid main() {{ color = vec4(burnish_{0}(vec3(0, 0, 1), vec3(0, 0, 1)) + "
     "burnish_{0}_world(vec3(1), vec3(1), vec3(1), vec3(1)), 1); }}\n",
     "glslangValidator {}"},
    {ShaderLanguage::glsl_es, "glslangValidator", "frag", "#version 300 es\n",
     "out vec4 color;\nvoid main() {{ color = vec4(burnish_{0}(vec3(0, 0, 1), vec3(0, 0, 1)) + "
     "burnish_{0}_world(vec3(1), vec3(1), vec3(1), vec3(1)), 1); }}\n",
     "glslangValidator {}"},
    {ShaderLanguage::hlsl, "glslangValidator", "frag.hlsl", "",
     "float4 main(float4 at : SV_Position) : SV_Target {{ return float4(burnish_{0}(at.xyz, at.xyz) + "
     "burnish_{0}_world(at.xyz, at.xyz, at.xyz, at.xyz), 1.0); }}\n",
     "for f in{}; do glslangValidator -D -e main -S frag -V -o /dev/null $f || exit 1; done"},
    // The HLSL of glslang has all that generated Slang uses; tests/shaders/compile.py has Slang's own compiler.
    {ShaderLanguage::slang, "glslangValidator", "frag.hlsl", "",
     "float4 main(float4 at : SV_Position) : SV_Target {{ return float4(burnish_{0}(at.xyz, at.xyz) + "
     "burnish_{0}_world(at.xyz, at.xyz, at.xyz, at.xyz), 1.0); }}\n",
     "for f in{}; do glslangValidator -D -e main -S frag -V --auto-map-bindings -o /dev/null $f || exit 1; "
     "done"},
    {ShaderLanguage::wgsl, "naga", "wgsl", "",
     "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {{ return "
     "vec4f(burnish_{0}(at.xyz, "
     "at.xyz) + burnish_{0}_world(at.xyz, at.xyz, at.xyz, at.xyz), 1.0); }}\n",
     "naga --bulk-validate {}"},
};

}  // namespace burnish
