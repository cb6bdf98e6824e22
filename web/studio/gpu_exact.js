// Draws measurements by their own interpolation on the GPU: whole half/difference tables (MERL) and RGL's tables.
import {texture} from "./gl.js";
import {toRgb} from "./vectors.js";

const kMaxStored = 32768;  // limit of stored values; larger ones are scaled down

// This code computes theta_h, phi_h, theta_d, phi_d of a pair.
export const kAngles = `
const float kHalfPi = 1.5707963268;
// [Rusinkiewicz 1998]
vec4 angles(vec3 wi, vec3 wo) {
  vec3 h = normalize(wi + wo);
  float sine = length(h.xy);
  vec2 along = sine > 1e-6 ? h.xy / sine : vec2(1.0, 0.0);
  vec3 e1 = vec3(h.z * along, -sine), e2 = vec3(-along.y, along.x, 0.0);
  vec2 d = vec2(dot(wi, e1), dot(wi, e2));
  return vec4(atan(sine, h.z), atan(along.y, along.x), atan(length(d), dot(wi, h)), atan(d.y, d.x));
}`;

// Unknown cells have no weight, and the other weights are scaled to sum to 1. This equals the filtered sum divided by
// the filtered share of known cells.
const kHalfDiff = `
uniform highp sampler3D brdf_table;  // phi_d, theta_d, theta_h; rgb where it is known, times 1, else 0
uniform vec2 brdf_how;               // of stored values; turns of phi_d a circle
vec3 brdf(vec3 wi, vec3 wo) {
  if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
  vec4 a = angles(wi, wo);
  vec4 f = textureLod(brdf_table, vec3(a.w / (4.0 * kHalfPi) * brdf_how.y, a.z / kHalfPi, sqrt(a.x / kHalfPi)), 0.0);
  return f.a > 0.0 ? brdf_how.x * max(f.rgb / f.a, 0.0) : vec3(0.0);
}`;

export function fromHalfDiff(gl, {size: [thetaH, thetaD, phiD], fullCircle, channels, data}) {
  const rgb = toRgb(data, channels), cells = new Float32Array((4 * rgb.length) / 3);
  let largest = 0;
  for (let i = 0; i < rgb.length; ++i) if (rgb[i] > largest) largest = rgb[i];
  const factor = Math.max(largest / kMaxStored, 1);
  for (let i = 0; i < rgb.length / 3; ++i) {
    if (Number.isNaN(rgb[3 * i])) continue;
    for (let c = 0; c < 3; ++c) cells[4 * i + c] = rgb[3 * i + c] / factor;
    cells[4 * i + 3] = 1;
  }
  const made = texture(gl, {width: phiD, height: thetaD, depth: thetaH, repeat: "s", internal: gl.RGBA16F, format: gl.RGBA, type: gl.FLOAT, data: cells});
  return {glsl: kAngles + kHalfDiff, textures: [{name: "brdf_table", ...made}], set: ({at}) => gl.uniform2f(at("brdf_how"), factor, fullCircle ? 1 : 2)};
}

// This code matches src/burnish/reflectance/rgl_table.cpp and conditional_warp.cpp [Dupuy 2018, sec. 4].
const kRgl = `
uniform highp sampler3D brdf_vndf, brdf_spectra;  // slices along z; of vndf density and integral from the row's start
uniform highp sampler2D brdf_rows, brdf_ndf, brdf_sigma, brdf_nodes;
uniform vec4 brdf_turn;  // cosine and sine of the first phi_i, signs of the quadrant that is stored
uniform ivec4 brdf_how;  // numbers of theta_i and phi_i, how often phi_i fit in a circle, whether a Jacobian is divided out
const float kPi = 3.14159265359;
float node(int row, int k) { return texelFetch(brdf_nodes, ivec2(k, row), 0).r; }
vec2 locate(int row, int count, float x) {
  int i = 0;
  if (count == 1) return vec2(0.0);
  while (i + 2 < count && node(row, i + 1) <= x) ++i;
  float a = node(row, i), b = node(row, i + 1);
  return vec2(float(i), clamp((x - a) / (b - a), 0.0, 1.0));
}
vec2 square(float theta, float phi) { return vec2(min(sqrt(theta * 2.0 / kPi), 1.0), clamp((phi + kPi) / (2.0 * kPi), 0.0, 1.0)); }
float azimuth(float y, float x) { return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x); }
// the cell of a grid that holds p: column, row, place within
vec4 cell(vec2 p, ivec2 size) {
  vec2 at = p * vec2(size - 1), low = min(floor(at), vec2(size - 2));
  return vec4(low, at - low);
}
float grid(highp sampler2D map, vec2 p) {
  vec4 c = cell(p, textureSize(map, 0));
  ivec2 i = ivec2(c.xy);
  return mix(mix(texelFetch(map, i, 0).r, texelFetch(map, i + ivec2(1, 0), 0).r, c.z),
             mix(texelFetch(map, i + ivec2(0, 1), 0).r, texelFetch(map, i + ivec2(1, 1), 0).r, c.z), c.w);
}
float integral(float a, float b, float t) { return t * (a + 0.5 * t * (b - a)); }
vec3 brdf(vec3 wi, vec3 wo) {
  if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
  // into the part of the circle that is stored
  vec2 flip = vec2(1.0);
  if (brdf_how.z == 2 && wi.y * brdf_turn.x - wi.x * brdf_turn.y < 0.0) flip = vec2(-1.0);
  if (brdf_how.z == 4) flip = vec2(wi.x * brdf_turn.z < 0.0 ? -1.0 : 1.0, wi.y * brdf_turn.w < 0.0 ? -1.0 : 1.0);
  wi.xy *= flip;
  wo.xy *= flip;
  vec3 h = wi + wo;
  float theta_i = atan(length(wi.xy), wi.z), theta_h = atan(length(h.xy), h.z), phi_i = 0.0, phi_h;
  vec2 polar = locate(0, brdf_how.x, theta_i), around = vec2(0.0);
  ivec2 rows = ivec2(0);
  if (brdf_how.y <= 2) {
    vec2 along = wi.x == 0.0 && wi.y == 0.0 ? vec2(1.0, 0.0) : wi.xy;
    phi_h = azimuth(along.x * h.y - along.y * h.x, dot(along, h.xy));
  } else {
    phi_i = azimuth(wi.y, wi.x);
    phi_h = azimuth(h.y, h.x);
    float first = node(1, 0), last = node(1, brdf_how.y - 1), phi = phi_i - 2.0 * kPi * floor((phi_i - first) / (2.0 * kPi));
    around = locate(1, brdf_how.y, phi);
    rows = ivec2(int(around.x), int(around.x) + 1);
    if (phi > last) {
      float gap = first + 2.0 * kPi - last, beyond = gap > 0.0 ? min((phi - last) / gap, 1.0) : 0.0;
      around.y = brdf_how.z == 1 ? beyond : floor(beyond + 0.5);
      rows = ivec2(brdf_how.y - 1, 0);
    }
  }
  ivec4 slices = int(polar.x) + rows.xxyy * brdf_how.x + ivec4(0, 1, 0, 1);
  vec4 weights = vec4(1.0 - around.y, 1.0 - around.y, around.y, around.y) * vec4(1.0 - polar.y, polar.y, 1.0 - polar.y, polar.y);

  // the warp by visible normals inverted
  vec2 p = square(theta_h, phi_h);
  vec4 c = cell(p, textureSize(brdf_vndf, 0).xy);
  ivec2 i = ivec2(c.xy);
  vec2 n00 = vec2(0.0), n10 = n00, n01 = n00, n11 = n00, r0 = n00, r1 = n00;
  for (int k = 0; k < 4; ++k) {
    if (weights[k] == 0.0) continue;
    n00 += weights[k] * texelFetch(brdf_vndf, ivec3(i, slices[k]), 0).rg;
    n10 += weights[k] * texelFetch(brdf_vndf, ivec3(i + ivec2(1, 0), slices[k]), 0).rg;
    n01 += weights[k] * texelFetch(brdf_vndf, ivec3(i + ivec2(0, 1), slices[k]), 0).rg;
    n11 += weights[k] * texelFetch(brdf_vndf, ivec3(i + ivec2(1, 1), slices[k]), 0).rg;
    r0 += weights[k] * texelFetch(brdf_rows, ivec2(i.y, slices[k]), 0).rg;
    r1 += weights[k] * texelFetch(brdf_rows, ivec2(i.y + 1, slices[k]), 0).rg;
  }
  float total = mix(r0.x, r1.x, c.w);
  float in_row = mix(n00.y, n01.y, c.w) + integral(mix(n00.x, n01.x, c.w), mix(n10.x, n11.x, c.w), c.z);
  vec2 at = vec2(total > 0.0 ? min(in_row / total, 1.0) : p.x, min(r0.y + integral(r0.x, r1.x, c.w), 1.0));

  // what the stored values were multiplied by
  float scale = 1.0 / max(wo.z, 1e-6);
  if (brdf_how.w == 1) scale *= grid(brdf_ndf, p) / (4.0 * max(grid(brdf_sigma, square(theta_i, phi_i)), 1.2e-38));
  c = cell(at, textureSize(brdf_spectra, 0).xy);
  i = ivec2(c.xy);
  vec3 f = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    if (weights[k] == 0.0) continue;
    f += weights[k] * mix(mix(texelFetch(brdf_spectra, ivec3(i, slices[k]), 0).rgb, texelFetch(brdf_spectra, ivec3(i + ivec2(1, 0), slices[k]), 0).rgb, c.z),
                          mix(texelFetch(brdf_spectra, ivec3(i + ivec2(0, 1), slices[k]), 0).rgb, texelFetch(brdf_spectra, ivec3(i + ivec2(1, 1), slices[k]), 0).rgb, c.z), c.w);
  }
  return max(scale * f, 0.0);
}`;

// Returns for each node its density and the integral from its row's start, and for each row its integral and that of
// the rows before. A slice's sum is 1.
function warpOf(density, [width, height]) {
  const slice = width * height, nodes = new Float32Array(2 * density.length), rows = new Float32Array((2 * density.length) / width);
  for (let first = 0; first < density.length; first += slice) {
    const before = new Float64Array(slice), total = new Float64Array(height);
    let sum = 0, above = 0;
    for (let y = 0; y < height; ++y) {
      for (let x = 1; x < width; ++x) {
        const i = y * width + x;
        before[i] = before[i - 1] + 0.5 * (density[first + i] + density[first + i - 1]);
      }
      total[y] = before[(y + 1) * width - 1];
      if (y > 0) sum += 0.5 * (total[y] + total[y - 1]);
    }
    for (let y = 0; y < height; ++y) {
      if (y > 0) above += 0.5 * (total[y] + total[y - 1]);
      rows.set([total[y] / sum, above / sum], 2 * (first / width + y));
    }
    for (let i = 0; i < slice; ++i) nodes.set([density[first + i] / sum, before[i] / sum], 2 * (first + i));
  }
  return {nodes, rows};
}

export function fromRgl(gl, {channels, isotropic, reduction, jacobian, phi, theta, ndf, sigma, vndf, spectra, data}) {
  const slices = phi.length * theta.length, {nodes, rows} = warpOf(data.vndf, vndf);
  const how = {type: gl.FLOAT, filter: gl.NEAREST}, red = {...how, internal: gl.R32F, format: gl.RED}, pair = {...how, internal: gl.RG32F, format: gl.RG};
  const longest = Math.max(phi.length, theta.length), angles = new Float32Array(2 * longest);
  angles.set(theta);
  angles.set(phi, longest);
  const made = {
    brdf_vndf: {...pair, width: vndf[0], height: vndf[1], depth: slices, data: nodes},
    brdf_rows: {...pair, width: vndf[1], height: slices, data: rows},
    brdf_ndf: {...red, width: ndf[0], height: ndf[1], data: data.ndf},
    brdf_sigma: {...red, width: sigma[0], height: sigma[1], data: data.sigma},
    brdf_nodes: {...red, width: longest, height: 2, data: angles},
    brdf_spectra: {...how, internal: gl.RGB32F, format: gl.RGB, width: spectra[0], height: spectra[1], depth: slices, data: toRgb(data.spectra, channels)},
  };
  const middle = 0.5 * (phi[0] + phi.at(-1));
  const set = ({at}) => {
    gl.uniform4f(at("brdf_turn"), Math.cos(phi[0]), Math.sin(phi[0]), Math.cos(middle), Math.sin(middle));
    gl.uniform4i(at("brdf_how"), theta.length, isotropic ? 1 : phi.length, reduction, jacobian ? 1 : 0);
  };
  return {glsl: kRgl, textures: Object.entries(made).map(([name, is]) => ({name, ...texture(gl, is)})), set};
}
