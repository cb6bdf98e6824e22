// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/formula/language.h>
#include <burnish/math/closest_name.h>

namespace burnish {

namespace {

using Calls = std::map<Op, Language::Call>;

constexpr Language::Call kTernary{"{0} < {1} ? {2} : {3}", 0};

// clang-format off
const Calls kCMath = {
    {Op::abs, {"fabsf({0})"}}, {Op::max, {"fmaxf({0}, {1})"}}, {Op::min, {"fminf({0}, {1})"}}, {Op::if_less, kTernary},
    {Op::floor, {"floorf({0})"}}, {Op::sqrt, {"sqrtf({0})"}}, {Op::power, {"powf({0}, {1})"}},
    {Op::exp2, {"exp2f({0})"}}, {Op::log2, {"log2f({0})"}}, {Op::acos, {"acosf({0})"}}, {Op::cos, {"cosf({0})"}}, {Op::sin, {"sinf({0})"}},
    {Op::exponent_of, {"power_exponent_of({0})"}}, {Op::scale_by_two, {"ldexpf({0}, (int)({1}))"}},
    {Op::to_integer, {"(int)({0})"}}, {Op::to_real, {"(float)({0})"}}};
const Calls kShaderMath = {
    {Op::abs, {"abs({0})"}}, {Op::max, {"max({0}, {1})"}}, {Op::min, {"min({0}, {1})"}}, {Op::if_less, kTernary},
    {Op::floor, {"floor({0})"}}, {Op::sqrt, {"sqrt({0})"}}, {Op::power, {"pow({0}, {1})"}},
    {Op::exp2, {"exp2({0})"}}, {Op::log2, {"log2({0})"}}, {Op::acos, {"acos({0})"}}, {Op::cos, {"cos({0})"}}, {Op::sin, {"sin({0})"}},
    {Op::exponent_of, {"power_exponent_of({0})"}}, {Op::scale_by_two, {"ldexp({0}, int({1}))"}},
    {Op::to_integer, {"int({0})"}}, {Op::to_real, {"float({0})"}}};
const Calls kRustMath = {
    {Op::abs, {"({0}).abs()"}}, {Op::max, {"({0}).max({1})"}}, {Op::min, {"({0}).min({1})"}},
    {Op::if_less, {"if {0} < {1} {{ {2} }} else {{ {3} }}", 0}},
    {Op::floor, {"({0}).floor()"}}, {Op::sqrt, {"({0}).sqrt()"}}, {Op::power, {"({0}).powf({1})"}},
    {Op::exp2, {"({0}).exp2()"}}, {Op::log2, {"({0}).log2()"}}, {Op::acos, {"({0}).acos()"}}, {Op::cos, {"({0}).cos()"}}, {Op::sin, {"({0}).sin()"}},
    {Op::exponent_of, {"power_exponent_of({0})"}}, {Op::scale_by_two, {"{0} * ({1}).exp2()", 2}},
    {Op::to_integer, {"({0}) as i32"}}, {Op::to_real, {"({0}) as f32"}}};
// clang-format on

// Returns calls with some of them replaced.
Calls with(Calls calls, const Calls& others) {
  for (const auto& [op, call] : others) calls[op] = call;
  return calls;
}

// The GLSL names that generated C++ uses. It has its own vec3, since CUDA's float3 has no operators.
constexpr std::string_view kCppHeader = R"(
#ifndef BURNISH_SHADER_TYPES
#define BURNISH_SHADER_TYPES
#include <math.h>
#ifdef __CUDACC__
#define BURNISH_FUNCTION __device__ inline
#define BURNISH_CONSTANT __device__ const
#else
#define BURNISH_FUNCTION inline
#define BURNISH_CONSTANT static const
#endif
namespace burnish_shader {
struct vec3 {
  float x, y, z;
  BURNISH_FUNCTION vec3(float a, float b, float c) : x(a), y(b), z(c) {}
};
BURNISH_FUNCTION vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
BURNISH_FUNCTION vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
BURNISH_FUNCTION vec3 operator*(vec3 a, vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
BURNISH_FUNCTION vec3 operator*(float a, vec3 b) { return {a * b.x, a * b.y, a * b.z}; }
BURNISH_FUNCTION vec3 operator*(vec3 a, float b) { return b * a; }
BURNISH_FUNCTION float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BURNISH_FUNCTION vec3 cross(vec3 a, vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BURNISH_FUNCTION float abs(float a) { return ::fabsf(a); }
BURNISH_FUNCTION float min(float a, float b) { return b < a ? b : a; }
BURNISH_FUNCTION float max(float a, float b) { return a < b ? b : a; }
BURNISH_FUNCTION float sqrt(float a) { return ::sqrtf(a); }
BURNISH_FUNCTION float floor(float a) { return ::floorf(a); }
BURNISH_FUNCTION float pow(float a, float b) { return ::powf(a, b); }
}  // namespace burnish_shader
#endif
)";

// Returns the patterns that languages share.
Language c_like(std::string_view name, std::string_view suffix) {
  return {.name = name,
          .suffix = suffix,
          .scalar = "float",
          .vector = {},
          .integer = "int",
          .local = "  const {0} {1} = {2};\n",
          .result = "  return {};\n",
          .parameter = "{0} {1}",
          .definition = {},
          .header = {},
          .math = {},
          .exponent_of = {},
          .calls = {},
          .texel = {},
          .texel_3d = {},
          .sample = {},
          .sample_3d = {},
          .sample_1d = {},
          .array = {},
          .texture_1d = {},
          .texture = {},
          .texture_3d = {},
          .filtered_texture = {},
          .filtered_texture_3d = {},
          .unbound = {},
          .bound = {},
          .placed = {},
          .half_scalar = {},
          .half_vector = {},
          .half_constructor = {},
          .half_from_scalar = {},
          .half_from_vector = {},
          .half_suffix = {},
          .half_header = {},
          .texture_struct = {},
          .map_read = {},
          .map_parameter = {},
          .map_template = {},
          .member = "  {0} {1};\n",
          .structure = "struct {0} {{\n{1}}};\n",
          .made = {}};
}

// C: static functions of floats, without textures or vectors.
Language c() {
  Language l = c_like("c", "f");
  l.definition = "static inline {0} {1}({2}) {{\n{3}}}\n";
  l.math = "#include <math.h>\n\n";
  l.exponent_of =
      "#include <math.h>\n#include <string.h>\n\n"
      "// n where x = m 2^n, m in [0.645, 1.29)\n"
      "static inline float power_exponent_of(float x) {\n"
      "  int bits;\n  memcpy(&bits, &x, sizeof bits);\n  return (float)((bits - 0x3f251eb8) >> 23);\n}\n\n";
  l.calls = kCMath;
  return l;
}

// CUDA: C's functions for the device.
Language cuda() {
  Language l = c_like("cuda", "f");
  l.definition = "__device__ inline {0} {1}({2}) {{\n{3}}}\n";
  l.exponent_of =
      "// n where x = m 2^n, m in [0.645, 1.29)\n"
      "__device__ inline float power_exponent_of(float x) {\n"
      "  return (float)((__float_as_int(x) - 0x3f251eb8) >> 23);\n}\n\n";
  l.calls = kCMath;
  return l;
}

// C++ and CUDA through macros: the GLSL names with a vec3 of its own, and tables as arrays.
Language cpp() {
  Language l = c_like("cpp", "f");
  l.vector = "vec3";
  l.local = "  {0} {1} = {2};\n";
  l.definition = "BURNISH_FUNCTION {0} {1}({2}) {{\n{3}}}\n";
  l.header = kCppHeader;
  l.calls = with(kShaderMath, {{Op::exp2, {"::exp2f({0})"}},
                               {Op::log2, {"::log2f({0})"}},
                               {Op::acos, {"::acosf({0})"}},
                               {Op::cos, {"::cosf({0})"}},
                               {Op::sin, {"::sinf({0})"}}});
  l.texel = "{0}_at({1}, {2})";
  l.map_read = "  const auto {0} = maps.sample({2}, u, v, lod);\n";
  l.map_parameter = "const Maps& maps";
  l.map_template = "template <class Maps>\n";
  l.made = "  return {{{1}}};\n";
  return l;
}

// GLSL 4.50.
Language glsl() {
  Language l = c_like("glsl", "");
  l.vector = "vec3";
  l.local = "  {0} {1} = {2};\n";
  l.definition = "{0} {1}({2}) {{\n{3}}}\n";
  l.exponent_of =
      "// n where x = m 2^n, m in [0.645, 1.29)\n"
      "float power_exponent_of(float x) {\n"
      "  return float((floatBitsToInt(x) - 0x3f251eb8) >> 23);\n}\n\n";
  l.calls = kShaderMath;
  l.texel = "texelFetch({0}, ivec2({1}, {2}), 0).{3}";
  l.texel_3d = "texelFetch({0}, ivec3({1}, {2}, {3}), 0).{4}";
  l.sample = "textureLod({0}, vec2({1}, {2}), 0.0).{3}";
  l.sample_3d = "textureLod({0}, vec3({1}, {2}, {3}), 0.0).{4}";
  l.sample_1d = "textureLod({0}, {1}, 0.0).{2}";
  l.bound = "layout(binding = {1}) ";
  l.placed = "layout(set = {0}, binding = {1}) ";
  l.texture_1d = "{4}uniform sampler1D {0};\n";
  l.array = "const float {0}[{1}] = float[]({2});\n";
  l.texture = l.filtered_texture = "{4}uniform sampler2D {0};\n";
  l.texture_3d = l.filtered_texture_3d = "{4}uniform sampler3D {0};\n";
  l.half_scalar = "mediump float";
  l.half_vector = "mediump vec3";
  l.half_constructor = "vec3";
  l.map_read = "  vec4 {0} = textureLod({1}, vec2(u, v), lod);\n";
  l.made = "  return {0}({1});\n";
  return l;
}

// GLSL ES 3.00: GLSL with declared precisions, without 1-D textures and bindings, and with exp2 in place of ldexp.
// Samplers have their own precision, so that the user's samplers keep theirs.
Language glsl_es() {
  Language l = glsl();
  l.name = "glsl_es";
  l.sample_1d = l.texture_1d = l.bound = l.placed = {};
  l.header = l.half_header = "precision highp float;\nprecision highp int;\n";
  l.texture = l.filtered_texture = "uniform {6} sampler2D {0};\n";
  l.texture_3d = l.filtered_texture_3d = "uniform {6} sampler3D {0};\n";
  l.calls = with(kShaderMath, {{Op::scale_by_two, {"{0} * exp2({1})", 2}}});
  return l;
}

// HLSL: textures and samplers have registers.
Language hlsl() {
  Language l = c_like("hlsl", "");
  l.vector = "float3";
  l.local = "  {0} {1} = {2};\n";
  l.half_scalar = l.half_from_scalar = "min16float";
  l.half_vector = l.half_constructor = l.half_from_vector = "min16float3";
  l.definition = "{0} {1}({2}) {{\n{3}}}\n";
  l.exponent_of =
      "// n where x = m 2^n, m in [0.645, 1.29)\n"
      "float power_exponent_of(float x) {\n  return float((asint(x) - 0x3f251eb8) >> 23);\n}\n\n";
  l.calls = with(kShaderMath, {{Op::scale_by_two, {"ldexp({0}, {1})"}}});
  l.texel = "{0}.Load(int3({1}, {2}, 0)).{3}";
  l.texel_3d = "{0}.Load(int4({1}, {2}, {3}, 0)).{4}";
  l.sample = "{0}.SampleLevel({0}_sampler, float2({1}, {2}), 0.0).{3}";
  l.sample_3d = "{0}.SampleLevel({0}_sampler, float3({1}, {2}, {3}), 0.0).{4}";
  l.texture = "Texture2D<float4> {0} : register(t{1}{4});\n";
  l.texture_3d = "Texture3D<float4> {0} : register(t{1}{4});\n";
  l.filtered_texture =
      "Texture2D<float4> {0} : register(t{1}{4});\nSamplerState {0}_sampler : register(s{1}{4});\n";
  l.filtered_texture_3d =
      "Texture3D<float4> {0} : register(t{1}{4});\nSamplerState {0}_sampler : register(s{1}{4});\n";
  l.placed = ", space{0}";
  l.map_read = "  float4 {0} = {1}.SampleLevel({1}_sampler, float2(u, v), lod);\n";
  l.made = "  {0} place = {{ {1} }};\n  return place;\n";
  return l;
}

// Slang: HLSL whose compiler gives textures their places unless told, and whose halves every target has.
Language slang() {
  Language l = hlsl();
  l.name = "slang";
  l.half_scalar = l.half_from_scalar = "half";
  l.half_vector = l.half_constructor = l.half_from_vector = "half3";
  l.bound = "[[vk::binding({2})]] ";
  l.placed = "[[vk::binding({2}, {0})]] ";
  l.texture = "{4}Texture2D<float4> {0};\n";
  l.texture_3d = "{4}Texture3D<float4> {0};\n";
  l.filtered_texture = "{4}Texture2D<float4> {0};\n{5}SamplerState {0}_sampler;\n";
  l.filtered_texture_3d = "{4}Texture3D<float4> {0};\n{5}SamplerState {0}_sampler;\n";
  return l;
}

// MSL: textures stand in a struct that is an argument.
Language msl() {
  Language l = c_like("msl", "f");
  l.vector = "float3";
  l.definition = "inline {0} {1}({2}) {{\n{3}}}\n";
  l.header =
      "// No compiler has checked this file: none for MSL is at hand where it is tested.\n"
      "#include <metal_stdlib>\nusing namespace metal;\n";
  l.half_header = l.header;
  l.half_scalar = l.half_from_scalar = "half";
  l.half_vector = l.half_constructor = l.half_from_vector = "half3";
  l.half_suffix = "h";
  l.exponent_of =
      "// n where x = m 2^n, m in [0.645, 1.29)\n"
      "inline float power_exponent_of(float x) {\n"
      "  return float((as_type<int>(x) - 0x3f251eb8) >> 23);\n}\n\n";
  l.calls = kShaderMath;
  l.texel = "tables.{0}.read(uint2({1}, {2})).{3}";
  l.texel_3d = "tables.{0}.read(uint3({1}, {2}, {3})).{4}";
  l.sample = "tables.{0}.sample(smooth_sampler, float2({1}, {2}), level(0.0f)).{3}";
  l.sample_3d = "tables.{0}.sample(smooth_sampler, float3({1}, {2}, {3}), level(0.0f)).{4}";
  l.texture = l.filtered_texture = "  texture2d<float> {0};\n";
  l.texture_3d = l.filtered_texture_3d = "  texture3d<float> {0};\n";
  l.texture_struct = "struct {0} {{\n{1}}};\n";
  l.map_read = "  const float4 {0} = maps.{1}.sample(map_sampler, float2(u, v), level(lod));\n";
  l.map_parameter = "{0} maps";
  l.made = "  return {{{1}}};\n";
  return l;
}

// Rust: methods in place of functions, types after names.
Language rust() {
  Language l = c_like("rust", "f32");
  l.scalar = "f32";
  l.integer = "i32";
  l.local = "    let {1} = {2};\n";
  l.result = "    {}\n";
  l.parameter = "{1}: {0}";
  l.definition = "pub fn {1}({2}) -> {0} {{\n{3}}}\n";
  l.exponent_of =
      "/// n where x = m 2^n, m in [0.645, 1.29)\n"
      "fn power_exponent_of(x: f32) -> f32 {\n    ((x.to_bits() as i32 - 0x3f251eb8) >> 23) as f32\n}\n\n";
  l.calls = kRustMath;
  return l;
}

// WGSL: types after names, select() for conditions, textures and samplers have bindings.
Language wgsl() {
  Language l = c_like("wgsl", "");
  l.scalar = "f32";
  l.vector = "vec3f";
  l.half_header = "enable f16;\n";
  l.half_scalar = l.half_from_scalar = "f16";
  l.half_vector = l.half_constructor = l.half_from_vector = "vec3h";
  l.half_suffix = "h";
  l.integer = "i32";
  l.local = "  let {1} = {2};\n";
  l.parameter = "{1}: {0}";
  l.definition = "fn {1}({2}) -> {0} {{\n{3}}}\n";
  l.exponent_of =
      "// n where x = m 2^n, m in [0.645, 1.29)\n"
      "fn power_exponent_of(x: f32) -> f32 {\n  return f32((bitcast<i32>(x) - 0x3f251eb8) >> 23u);\n}\n\n";
  l.calls = with(kShaderMath, {{Op::if_less, {"select({3}, {2}, {0} < {1})"}},
                               {Op::scale_by_two, {"ldexp({0}, i32({1}))"}},
                               {Op::to_integer, {"i32({0})"}},
                               {Op::to_real, {"f32({0})"}}});
  l.texel = "textureLoad({0}, vec2i({1}, {2}), 0).{3}";
  l.texel_3d = "textureLoad({0}, vec3i({1}, {2}, {3}), 0).{4}";
  l.sample = "textureSampleLevel({0}, {0}_sampler, vec2f({1}, {2}), 0.0).{3}";
  l.sample_3d = "textureSampleLevel({0}, {0}_sampler, vec3f({1}, {2}, {3}), 0.0).{4}";
  l.unbound = l.bound = "0";
  l.placed = "{0}";
  l.texture = "@group({4}) @binding({1}) var {0}: texture_2d<f32>;\n";
  l.texture_3d = "@group({4}) @binding({1}) var {0}: texture_3d<f32>;\n";
  l.filtered_texture =
      "@group({4}) @binding({2}) var {0}: texture_2d<f32>;\n@group({4}) @binding({3}) var {0}_sampler: "
      "sampler;\n";
  l.filtered_texture_3d =
      "@group({4}) @binding({2}) var {0}: texture_3d<f32>;\n@group({4}) @binding({3}) var {0}_sampler: "
      "sampler;\n";
  l.map_read = "  let {0} = textureSampleLevel({1}, {1}_sampler, vec2f(u, v), lod);\n";
  l.member = "  {1}: {0},\n";
  l.structure = "struct {0} {{\n{1}}}\n";
  l.made = "  return {0}({1});\n";
  return l;
}

constexpr std::string_view channels_of(ValueType type) noexcept {
  return type == ValueType::vector ? "rgb" : "r";
}

// Reads a texture that has as many dimensions as there are coordinates.
std::string read_at(std::string_view of_two, std::string_view of_three, std::string_view texture,
                    std::span<const std::string> at, ValueType type) {
  if (at.size() == 2) return fmt::format(fmt::runtime(of_two), texture, at[0], at[1], channels_of(type));
  return fmt::format(fmt::runtime(of_three), texture, at[0], at[1], at[2], channels_of(type));
}

}  // namespace

std::span<const Language> languages() {
  static const Language kAll[] = {c(),    cuda(), cpp(),  glsl(),  glsl_es(),
                                  hlsl(), msl(),  rust(), slang(), wgsl()};
  return kAll;
}

const Language& language(std::string_view name) {
  std::vector<std::string_view> known;
  for (const Language& l : languages()) {
    if (l.name == name) return l;
    known.push_back(l.name);
  }
  throw Error("language: " + expected_one_of(known, name));
}

std::string_view Language::type_name(ValueType type, bool half) const noexcept {
  if (type == ValueType::integer) return integer;
  if (half) return type == ValueType::vector ? half_vector : half_scalar;
  return type == ValueType::vector ? vector : scalar;
}

std::string Language::literal(double value, bool half) const {
  // A literal has the fewest digits that give the float, or nine where the value is no float.
  const auto single = static_cast<float>(value);
  std::string digits =
      static_cast<double>(single) == value ? fmt::format("{}", single) : fmt::format("{:.9g}", value);
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return digits + std::string(half ? half_suffix : suffix);
}

std::string Language::declaration(ValueType type, std::string_view variable, std::string_view value,
                                  bool half) const {
  return fmt::format(fmt::runtime(local), type_name(type, half), variable, value);
}

std::string Language::function(ValueType type, std::string_view function_name,
                               std::span<const std::string_view> parameters, std::string_view more,
                               std::string_view body) const {
  std::string list;
  for (const std::string_view p : parameters)
    list += (list.empty() ? "" : ", ") + fmt::format(fmt::runtime(parameter), type_name(type), p);
  if (!more.empty()) list += fmt::format(", {}", more);
  return fmt::format(fmt::runtime(definition), type_name(type), function_name, list, body);
}

std::string Language::fetch(std::string_view texture_name, std::span<const std::string> at,
                            ValueType type) const {
  return read_at(texel, texel_3d, texture_name, at, type);
}

std::string Language::filtered(std::string_view texture_name, std::span<const std::string> at,
                               ValueType type) const {
  if (at.size() == 1) return fmt::format(fmt::runtime(sample_1d), texture_name, at[0], channels_of(type));
  return read_at(sample, sample_3d, texture_name, at, type);
}

std::string Language::declare_array(std::string_view array_name, std::span<const double> values) const {
  std::string list;
  for (const double value : values) list += (list.empty() ? "" : ", ") + literal(value);
  return fmt::format(fmt::runtime(array), array_name, values.size(), list);
}

}  // namespace burnish
