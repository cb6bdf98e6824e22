// GlRenderer's vertices; GLSL 4.50, after the #version line.
layout(location = 0) in vec3 burnish_position;
layout(location = 1) in vec3 burnish_normal_in;
layout(location = 2) in vec3 burnish_tangent_in;
layout(location = 3) in float burnish_side_in;
layout(location = 4) in vec3 burnish_value_in;
layout(location = 5) in vec2 burnish_uv_in;
uniform mat4 burnish_projection;
out vec3 burnish_place, burnish_normal, burnish_tangent, burnish_value;
out float burnish_side;
out vec2 burnish_uv;
invariant gl_Position;

void main() {
  burnish_place = burnish_position;
  burnish_normal = burnish_normal_in;
  burnish_tangent = burnish_tangent_in;
  burnish_side = burnish_side_in;
  burnish_value = burnish_value_in;
  burnish_uv = burnish_uv_in;
  gl_Position = burnish_projection * vec4(burnish_position, 1.0);
}
