#include <fmt/format.h>

#include <burnish/render/gl/surface_shader.h>

namespace burnish {

namespace {

// [HomomorphicBrdf, eq. 2]
constexpr const char* kFragmentShader = R"(
in vec3 burnish_place, burnish_normal, burnish_tangent;
in float burnish_side;
out vec4 burnish_color;
struct burnish_Light { vec4 place, intensity; };
layout(std140, binding = 0) uniform burnish_Lights { burnish_Light burnish_lights[512]; };
uniform int burnish_light_count;
uniform bool burnish_first;
uniform vec3 burnish_eye;
@DECLARATIONS
void main() {
  vec3 burnish_n = normalize(burnish_normal);
  vec3 burnish_t = normalize(burnish_tangent - dot(burnish_tangent, burnish_n) * burnish_n);
  vec3 burnish_s = sign(burnish_side) * cross(burnish_n, burnish_t);
  vec3 burnish_v = normalize(burnish_eye - burnish_place);
  vec3 wo = vec3(dot(burnish_t, burnish_v), dot(burnish_s, burnish_v), dot(burnish_n, burnish_v));
  vec3 burnish_sum = vec3(0.0);
@ENVIRONMENT
  if (wo.z > 0.0) {
@VIEW
    for (int burnish_i = 0; burnish_i < burnish_light_count; ++burnish_i) {
      vec3 burnish_away = burnish_lights[burnish_i].place.xyz - burnish_place;
      float burnish_square = dot(burnish_away, burnish_away);
      vec3 burnish_l = burnish_away * inversesqrt(burnish_square);
      vec3 wi = vec3(dot(burnish_t, burnish_l), dot(burnish_s, burnish_l), dot(burnish_n, burnish_l));
      if (wi.z > 0.0) {
@LIGHT
        burnish_sum += wi.z / burnish_square * burnish_lights[burnish_i].intensity.rgb * (@VALUE);
      }
    }
  }
  burnish_color = vec4(burnish_sum, 1.0);
}
)";

}  // namespace

const char* const kSceneVertexShader = R"(
layout(location = 0) in vec3 burnish_position;
layout(location = 1) in vec3 burnish_normal_in;
layout(location = 2) in vec3 burnish_tangent_in;
layout(location = 3) in float burnish_side_in;
layout(location = 4) in vec3 burnish_value_in;
uniform mat4 burnish_projection;
out vec3 burnish_place, burnish_normal, burnish_tangent, burnish_value;
out float burnish_side;
invariant gl_Position;
void main() {
  burnish_place = burnish_position;
  burnish_normal = burnish_normal_in;
  burnish_tangent = burnish_tangent_in;
  burnish_side = burnish_side_in;
  burnish_value = burnish_value_in;
  gl_Position = burnish_projection * vec4(burnish_position, 1.0);
}
)";

const char* const kInterpolatedFragmentShader = R"(
in vec3 burnish_value;
out vec4 burnish_color;
void main() { burnish_color = vec4(burnish_value, 1.0); }
)";

std::string scene_fragment_shader(const SurfaceShader& surface) {
  std::string text = kFragmentShader;
  const auto put = [&](std::string_view mark, const std::string& with) {
    text.replace(text.find(mark), mark.size(), with);
  };
  put("@VALUE", surface.value);
  put("@LIGHT", surface.light);
  put("@VIEW", surface.view);
  put("@ENVIRONMENT", surface.environment.empty()
                          ? ""
                          : fmt::format("  if (burnish_first) burnish_sum = {};", surface.environment));
  put("@DECLARATIONS", surface.declarations);
  return text;
}

SurfaceShader surface_shader(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision) {
  const bool filtered = filter == ShaderFilter::hardware;
  const SplitShader split = split_shader(brdf, {.filter = filter, .name = "model", .lines_are_1d = filtered});
  SurfaceShader surface{split.declarations, split.view, split.light, split.value, {}};
  for (const ShaderTexture& texture : split.textures)
    surface.textures.push_back(upload_of(texture, precision, filtered));
  return surface;
}

}  // namespace burnish
