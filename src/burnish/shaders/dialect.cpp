#include <fmt/format.h>

#include <burnish/shaders/dialect.h>

namespace burnish {

namespace {

// The GLSL names that generated C++ uses. It has its own vec3: CUDA's float3 has no operators.
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
BURNISH_FUNCTION float min(float a, float b) { return b < a ? b : a; }
BURNISH_FUNCTION float max(float a, float b) { return a < b ? b : a; }
BURNISH_FUNCTION float sqrt(float a) { return ::sqrtf(a); }
BURNISH_FUNCTION float floor(float a) { return ::floorf(a); }
BURNISH_FUNCTION float pow(float a, float b) { return ::powf(a, b); }
}  // namespace burnish_shader
#endif
)";

constexpr Dialect kDialects[] = {
    {ShaderLanguage::glsl, "float", "vec3", "int", "", "", ""},
    {ShaderLanguage::glsl_es, "float", "vec3", "int", "", "",
     "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"},
    {ShaderLanguage::hlsl, "float", "float3", "int", "", "", ""},
    {ShaderLanguage::msl, "float", "float3", "int", "f", "",
     "// No compiler has checked this file: none for MSL is at hand where it is tested.\n"
     "#include <metal_stdlib>\nusing namespace metal;\n"},
    {ShaderLanguage::wgsl, "f32", "vec3f", "i32", "", "let", ""},
    {ShaderLanguage::cpp, "float", "vec3", "int", "f", "", kCppHeader},
};

constexpr std::string_view swizzle(int channels) noexcept {
  return channels == 1 ? "r" : "rgb";
}

}  // namespace

const Dialect& dialect_of(ShaderLanguage language) noexcept {
  return kDialects[static_cast<std::size_t>(language)];
}

std::string_view to_string(ShaderLanguage language) noexcept {
  constexpr std::string_view kNames[] = {"glsl", "glsl_es", "hlsl", "msl", "wgsl", "cpp"};
  return kNames[static_cast<std::size_t>(language)];
}

std::string Dialect::declaration(std::string_view type, std::string_view name, std::string_view value) const {
  return fmt::format("  {} {} = {};\n", declare.empty() ? type : declare, name, value);
}

std::string Dialect::literal(double value) const {
  std::string digits = fmt::format("{}", static_cast<float>(value));
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return digits + std::string(suffix);
}

std::string Dialect::select(std::string_view condition, std::string_view yes, std::string_view no) const {
  if (language == ShaderLanguage::wgsl) return fmt::format("select({}, {}, {})", no, yes, condition);
  return fmt::format("{} ? {} : {}", condition, yes, no);
}

std::string Dialect::function(std::string_view name, std::initializer_list<std::string_view> vectors,
                              std::string_view more) const {
  const bool named_first = language == ShaderLanguage::wgsl;
  std::string arguments;
  for (const std::string_view v : vectors)
    arguments += fmt::format(fmt::runtime(named_first ? "{0}{2}: {1}" : "{0}{1} {2}"),
                             arguments.empty() ? "" : ", ", vector, v);
  if (!more.empty()) arguments += fmt::format(", {}", more);
  if (named_first) return fmt::format("fn {}({}) -> {} {{\n", name, arguments, vector);
  const std::string_view before = language == ShaderLanguage::cpp   ? "BURNISH_FUNCTION "
                                  : language == ShaderLanguage::msl ? "inline "
                                                                    : "";
  return fmt::format("{}{} {}({}) {{\n", before, vector, name, arguments);
}

std::string Dialect::fetch(std::string_view texture, std::string_view x, std::string_view y,
                           int channels) const {
  const std::string_view part = swizzle(channels);
  switch (language) {
    case ShaderLanguage::hlsl:
      return fmt::format("{}.Load(int3({}, {}, 0)).{}", texture, x, y, part);
    case ShaderLanguage::msl:
      return fmt::format("tables.{}.read(uint2({}, {})).{}", texture, x, y, part);
    case ShaderLanguage::wgsl:
      return fmt::format("textureLoad({}, vec2i({}, {}), 0).{}", texture, x, y, part);
    case ShaderLanguage::cpp:
      return fmt::format("{}_at({}, {})", texture, x, y);
    case ShaderLanguage::glsl:
    case ShaderLanguage::glsl_es:
      break;
  }
  return fmt::format("texelFetch({}, ivec2({}, {}), 0).{}", texture, x, y, part);
}

std::string Dialect::sample(std::string_view texture, std::string_view u, std::string_view v,
                            int channels) const {
  const std::string_view part = swizzle(channels);
  switch (language) {
    case ShaderLanguage::hlsl:
      return fmt::format("{0}.SampleLevel({0}_sampler, float2({1}, {2}), 0.0).{3}", texture, u, v, part);
    case ShaderLanguage::msl:
      return fmt::format("tables.{}.sample(smooth_sampler, float2({}, {}), level(0.0f)).{}", texture, u, v,
                         part);
    case ShaderLanguage::wgsl:
      return fmt::format("textureSampleLevel({0}, {0}_sampler, vec2f({1}, {2}), 0.0).{3}", texture, u, v,
                         part);
    default:
      if (v.empty()) return fmt::format("textureLod({}, {}, 0.0).{}", texture, u, part);
      return fmt::format("textureLod({}, vec2({}, {}), 0.0).{}", texture, u, v, part);
  }
}

}  // namespace burnish
