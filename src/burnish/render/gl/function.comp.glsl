// Calls a function of two vectors, which a line before this names burnish_called, for each pair of arguments.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Arguments { float arguments[]; };
layout(std430, binding = 1) writeonly buffer Values { float values[]; };
uniform uint count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 a = vec3(arguments[6u * i], arguments[6u * i + 1u], arguments[6u * i + 2u]);
  vec3 b = vec3(arguments[6u * i + 3u], arguments[6u * i + 4u], arguments[6u * i + 5u]);
  vec3 f = burnish_called(a, b);
  values[3u * i] = f.x;
  values[3u * i + 1u] = f.y;
  values[3u * i + 2u] = f.z;
}
