// GLSL of the view: the object lit by points and by an environment, the sum of frames, and their picture.

export const environments = ["none", "studio", "sky", "uniform", "picture"];
export const kLights = 4;  // point lights at most

export const objectVertex = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
uniform mat3 turn;
uniform vec2 zoom, jitter;
uniform float eye;
uniform float lift;  // along the normal
out vec3 place, n, t;
out vec2 at;  // of a surface laid over it from the front, v downwards
invariant gl_Position;
void main() {
  at = 0.5 + vec2(position.x, -position.y) / 1.7;
  place = turn * (position + lift * normal);
  n = turn * normal;
  t = turn * tangent;
  float w = eye - place.z, near = eye - 1.5, far = eye + 1.5;
  gl_Position = vec4(zoom * place.xy + jitter * w, (w * (far + near) - 2.0 * far * near) / (far - near), w);
}`;

// Environment lighting, y up; a studio has three soft boxes in a dim room.
const kEnvironment = `
uniform int around;
uniform highp sampler2D picture;
float box(vec3 d, vec3 middle, vec3 right, vec2 half_size, float soft) {
  vec3 up = cross(middle, right);
  float front = dot(d, middle);
  if (front <= 0.0) return 0.0;
  vec2 at = abs(vec2(dot(d, right), dot(d, up)) / front) - half_size;
  return smoothstep(soft, -soft, max(at.x, at.y));
}
vec3 environment(vec3 d) {
  if (around == 1) {
    vec3 sum = mix(vec3(0.14, 0.135, 0.13), vec3(0.3, 0.305, 0.32), smoothstep(-0.5, 1.0, d.y));
    sum += vec3(7.0, 6.7, 6.2) * box(d, normalize(vec3(-0.75, 0.65, 0.55)), normalize(vec3(0.55, 0.0, 0.75)), vec2(0.42, 0.6), 0.04);
    sum += vec3(2.6, 2.9, 3.4) * box(d, normalize(vec3(0.95, 0.2, 0.25)), normalize(vec3(0.25, 0.0, -0.95)), vec2(0.2, 0.8), 0.03);
    sum += vec3(3.0) * box(d, vec3(0.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0), vec2(0.9, 0.35), 0.05);
    return sum;
  }
  if (around == 2) {
    vec3 sun = normalize(vec3(-0.45, 0.6, 0.66));
    float y = d.y, glow = max(dot(d, sun), 0.0);
    vec3 sky = mix(vec3(0.75, 0.85, 1.0), vec3(0.18, 0.36, 0.8), pow(max(y, 0.0), 0.6));
    vec3 ground = vec3(0.2, 0.17, 0.14);
    return mix(ground, sky, smoothstep(-0.02, 0.03, y)) + vec3(16.0, 14.0, 11.0) * smoothstep(0.985, 0.995, glow) +
           vec3(0.6, 0.5, 0.35) * pow(glow, 24.0);
  }
  if (around == 3) return vec3(1.0);
  if (around == 4) {
    vec2 at = vec2(0.5 + atan(d.x, d.z) / 6.2831853, acos(clamp(d.y, -1.0, 1.0)) / 3.14159265);
    return textureLod(picture, at, 0.0).rgb;
  }
  return vec3(0.0);
}`;

// This code finds a pixel's place and the directions that light it. Half of the environment's directions are drawn by
// the cosine, half by the highlight of GGX facets as wide as the material's.
const kPixel = `
in vec3 place, n, t;
in vec2 at;
uniform float eye;
uniform vec3 lights[${kLights}], colors[${kLights}];
uniform int light_count, samples, first_sample;
uniform vec2 alpha;
vec3 viewer() { return normalize(vec3(0.0, 0.0, eye) - place); }
mat3 frame_of(vec3 v) {
  vec3 normal = normalize(n);
  // a pixel of the silhouette may have a normal that looks away
  normal = normalize(normal + max(1e-3 - dot(normal, v), 0.0) * v);
  vec3 tangent = normalize(t - dot(t, normal) * normal);
  return mat3(tangent, cross(normal, tangent), normal);
}
uint hash(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
vec2 offset_of(uvec2 pixel) {
  uint seed = hash(pixel.x + hash(pixel.y));
  return vec2(seed & 0xffffu, seed >> 16) / 65536.0;
}
// wi and its density; none where it is below the horizon
vec4 direction(int k, vec2 offset, vec3 wo) {
  vec2 u = fract(offset + float(k) * vec2(0.7548776662, 0.5698402910));
  float phi = 6.2831853 * u.y;
  vec3 wi;
  if ((k & 1) == 0) {
    float r = sqrt(u.x);
    wi = vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
  } else {
    float m = sqrt(u.x / max(1.0 - u.x, 1e-6));
    vec3 h = normalize(vec3(-alpha.x * m * cos(phi), -alpha.y * m * sin(phi), 1.0));
    wi = 2.0 * dot(wo, h) * h - wo;
  }
  if (wi.z <= 0.0) return vec4(wi, 0.0);
  vec3 h = normalize(wi + wo);
  vec3 scaled = vec3(h.xy / alpha, h.z);
  float length2 = dot(scaled, scaled), d = 1.0 / (3.14159265 * alpha.x * alpha.y * length2 * length2);
  return vec4(wi, 0.5 * wi.z / 3.14159265 + 0.5 * d * h.z / (4.0 * max(dot(wo, h), 1e-4)));
}`;

export const objectFragment = (brdf) => `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
${brdf}
${kEnvironment}
${kPixel}
out vec4 color;
vec3 around_light(mat3 frame, vec3 wo) {
  vec2 offset = offset_of(uvec2(gl_FragCoord.xy));
  vec3 sum = vec3(0.0);
  for (int k = 0; k < samples; ++k) {
    vec4 wi = direction(first_sample + k, offset, wo);
    if (wi.w > 0.0) sum += brdf(wi.xyz, wo) * environment(frame * wi.xyz) * (max(facing(wi.xyz), 0.0) / wi.w);
  }
  return sum / float(samples);
}
void main() {
  begin(at);
  vec3 v = viewer();
  mat3 frame = frame_of(v);
  vec3 wo = v * frame, sum = vec3(0.0);
  for (int i = 0; i < light_count; ++i) {
    vec3 to = lights[i] - place;
    vec3 wi = normalize(to) * frame;
    if (wi.z > 0.0) sum += brdf(wi, wo) * max(facing(wi), 0.0) * colors[i] / dot(to, to);
  }
  if (around > 0) sum += around_light(frame, wo);
  color = vec4(max(sum, 0.0), 1.0);
}`;

// Draws one part of a pixel's light: first the lights, then the environment's directions. The output is wi, wo or the
// factor of f_r. Alpha is set where there is light.
export const partFragment = `#version 300 es
precision highp float;
precision highp int;
${kEnvironment}
${kPixel}
uniform int part, which;
out vec4 color;
void main() {
  vec3 v = viewer();
  mat3 frame = frame_of(v);
  vec3 wo = v * frame, weight;
  vec4 wi;
  if (part < light_count) {
    vec3 to = lights[part] - place;
    wi = vec4(normalize(to) * frame, 1.0);
    weight = colors[part] / dot(to, to);
  } else {
    wi = direction(first_sample + part - light_count, offset_of(uvec2(gl_FragCoord.xy)), wo);
    weight = environment(frame * wi.xyz) / float(samples);
  }
  bool is = wi.z > 0.0 && wi.w > 0.0;
  color = vec4(which == 0 ? wi.xyz : which == 1 ? wo : is ? weight * wi.z / wi.w : vec3(0.0), is);
}`;

// Draws the values at given pairs, one a pixel.
export const pairsFragment = (brdf) => `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
${brdf}
uniform highp sampler2D pairs;  // wi in the upper row, wo in the lower one
out vec4 color;
void main() {
  int k = int(gl_FragCoord.x);
  begin(vec2(0.5));
  color = vec4(brdf(texelFetch(pairs, ivec2(k, 0), 0).xyz, texelFetch(pairs, ivec2(k, 1), 0).xyz), 1.0);
}`;

export const screenVertex = `#version 300 es
out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
}`;

export const sumFragment = `#version 300 es
precision highp float;
uniform highp sampler2D before, frame;
uniform float share;
out vec4 color;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  color = mix(texelFetch(before, p, 0), texelFetch(frame, p, 0), share);
}`;

// Averages the frames' errors where the exact values are known.
export const offFragment = `#version 300 es
precision highp float;
uniform highp sampler2D before, frame, exact;
uniform float share;
out vec4 color;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 is = texelFetch(exact, p, 0), drawn = texelFetch(frame, p, 0);
  vec3 off = is.a > 0.0 && drawn.a > 0.0 ? is.rgb - drawn.rgb : vec3(0.0);
  color = vec4(mix(texelFetch(before, p, 0).rgb, off, share), 0.0);
}`;

// Shows each side as its sum corrected by its error. `shown` is 0 for the left material, 1 for the right one, 2 for
// both around the divider, 3 for their difference.
export const pictureFragment = `#version 300 es
precision highp float;
uniform highp sampler2D left, right, left_off, right_off;
uniform vec2 shrunk;  // sides of what is read, of what is drawn
uniform float exposure, divider, factor;
uniform int curve, shown;
uniform vec3 background;
out vec4 color;
vec3 display(vec3 x) { return mix(12.92 * x, 1.055 * pow(max(x, 0.0031308), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x)); }
vec3 tone(vec4 pixel) {
  vec3 x = exposure * pixel.rgb / max(pixel.a, 1e-6);
  if (curve == 1) x = x * (1.0 + x / 16.0) / (1.0 + x);
  if (curve == 2) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  return display(clamp(x, 0.0, 1.0));
}
// dark blue, violet, orange, yellow: even steps of lightness
vec3 heat(float x) {
  vec3 a = mix(vec3(0.02, 0.02, 0.1), vec3(0.42, 0.1, 0.5), smoothstep(0.0, 0.33, x));
  a = mix(a, vec3(0.93, 0.41, 0.15), smoothstep(0.33, 0.66, x));
  return mix(a, vec3(0.99, 0.95, 0.6), smoothstep(0.66, 1.0, x));
}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy * shrunk);
  vec4 a = texelFetch(left, p, 0) + texelFetch(left_off, p, 0), b = texelFetch(right, p, 0) + texelFetch(right_off, p, 0);
  if (shown == 3) {
    vec3 apart = abs(tone(a) - tone(b));
    float error = max(apart.r, max(apart.g, apart.b));
    color = vec4(mix(background, heat(clamp(error * factor, 0.0, 1.0)), a.a), 1.0);
    return;
  }
  bool first = shown == 0 || (shown == 2 && gl_FragCoord.x < divider);
  vec4 pixel = first ? a : b;
  vec3 seen = mix(background, tone(pixel), pixel.a);
  color = vec4(seen, 1.0);
}`;

// Draws depths, and short lines along the tangents.
export const lineFragment = `#version 300 es
precision highp float;
uniform vec3 ink;
out vec4 color;
void main() { color = vec4(ink, 1.0); }`;
