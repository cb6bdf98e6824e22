// Light of a buffer of points, and from all around where it has some, that the parts of a SurfaceShader reflect.
// [HomomorphicBrdf, eq. 2]
in vec3 burnish_place, burnish_normal, burnish_tangent;
in float burnish_side;
in vec2 burnish_uv;  // v upwards
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
@PLACE
  vec3 burnish_v = normalize(burnish_eye - burnish_place);
  vec3 wo = vec3(dot(burnish_t, burnish_v), dot(burnish_s, burnish_v), dot(burnish_n, burnish_v));
  vec3 burnish_sum = vec3(0.0);
@ENVIRONMENT
  if (wo.z > 0.0) {
@VIEW
    int burnish_i = 0;
    while (true) {
      // The next light above the surface, of every pixel its own: pixels that are drawn together take as many turns as
      // shine on one of them, not as many as shine on any.
      vec3 burnish_away;
      for (; burnish_i < burnish_light_count; ++burnish_i) {
        burnish_away = burnish_lights[burnish_i].place.xyz - burnish_place;
        if (dot(burnish_n, burnish_away) > 0.0) break;
      }
      if (burnish_i >= burnish_light_count) break;
      float burnish_square = dot(burnish_away, burnish_away);
      vec3 burnish_l = burnish_away * inversesqrt(burnish_square);
      vec3 wi = vec3(dot(burnish_t, burnish_l), dot(burnish_s, burnish_l), dot(burnish_n, burnish_l));
@LIGHT
      burnish_sum += wi.z / burnish_square * burnish_lights[burnish_i].intensity.rgb * (@VALUE);
      ++burnish_i;
    }
  }
  burnish_color = vec4(burnish_sum, 1.0);
}
