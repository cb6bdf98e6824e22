// A material as GLSL: `vec3 brdf(vec3 wi, vec3 wo)` in the local frame, the textures it reads, and the roughness of its
// highlight. A model brings its own shader; anything else is tabulated over half/difference angles and read from a texture.
import {texture} from "./gl.js";
import {add, direction, fromHalfDiff, normalize, scale, toRgb} from "./vectors.js";

const kHalfPi = Math.PI / 2;
const kChunk = 1 << 18;      // pairs an evaluation
const kHorizon = 1e-3;       // cosine at which a direction below the horizon is looked up
const kLargestHalf = 32768;  // of what is stored; larger values are scaled down

// Nodes of theta_h crowd at the normal: theta_h = pi/2 x^2. Azimuths go round and have their nodes at k / count.
const kSizes = {
  isotropic: [{thetaH: 128, thetaD: 48, phiD: 48}],
  anisotropic: [{thetaH: 40, phiH: 24, thetaD: 12, phiD: 16}, {thetaH: 80, phiH: 36, thetaD: 24, phiD: 24}],
};

const kAngles = `
const float kHalfPi = 1.5707963268;
// theta_h, phi_h, theta_d, phi_d [Rusinkiewicz 1998]
vec4 angles(vec3 wi, vec3 wo) {
  vec3 h = normalize(wi + wo);
  float sine = length(h.xy);
  vec2 along = sine > 1e-6 ? h.xy / sine : vec2(1.0, 0.0);
  vec3 e1 = vec3(h.z * along, -sine), e2 = vec3(-along.y, along.x, 0.0);
  vec2 d = vec2(dot(wi, e1), dot(wi, e2));
  return vec4(atan(sine, h.z), atan(along.y, along.x), atan(length(d), dot(wi, h)), atan(d.y, d.x));
}`;

const kIsotropic = `
uniform highp sampler3D brdf_table;
uniform float brdf_scale;
vec3 brdf(vec3 wi, vec3 wo) {
  if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
  vec4 a = angles(wi, wo);
  vec3 size = vec3(textureSize(brdf_table, 0));
  vec2 nodes = vec2(sqrt(a.x / kHalfPi), a.z / kHalfPi) * (size.xy - 1.0);
  vec3 at = vec3((nodes + 0.5) / size.xy, a.w / (4.0 * kHalfPi) + 0.5 / size.z);
  return brdf_scale * textureLod(brdf_table, at, 0.0).rgb;
}`;

// theta_h and phi_d are filtered; slices of the other two angles are mixed here.
const kAnisotropic = `
uniform highp sampler3D brdf_table;
uniform float brdf_scale;
uniform vec2 brdf_slices;  // of phi_h, theta_d
vec3 slice(vec2 at, float phi, float theta) {
  float depth = brdf_slices.x * brdf_slices.y;
  return textureLod(brdf_table, vec3(at, (phi * brdf_slices.y + theta + 0.5) / depth), 0.0).rgb;
}
vec3 brdf(vec3 wi, vec3 wo) {
  if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
  vec4 a = angles(wi, wo);
  vec2 size = vec2(textureSize(brdf_table, 0).xy);
  vec2 at = vec2((sqrt(a.x / kHalfPi) * (size.x - 1.0) + 0.5) / size.x, a.w / (4.0 * kHalfPi) + 0.5 / size.y);
  float phi = fract(a.y / (4.0 * kHalfPi)) * brdf_slices.x, theta = a.z / kHalfPi * (brdf_slices.y - 1.0);
  float p0 = min(floor(phi), brdf_slices.x - 1.0), p1 = mod(p0 + 1.0, brdf_slices.x);
  float t0 = clamp(floor(theta), 0.0, brdf_slices.y - 2.0);
  vec3 low = mix(slice(at, p0, t0), slice(at, p0, t0 + 1.0), theta - t0);
  vec3 high = mix(slice(at, p1, t0), slice(at, p1, t0 + 1.0), theta - t0);
  return brdf_scale * mix(low, high, phi - p0);
}`;

// A direction below the horizon becomes one just above it: what is interpolated at grazing angles must not be 0.
function lifted(w) {
  if (w[2] >= kHorizon) return w;
  const flat = Math.hypot(w[0], w[1]) || 1, side = Math.sqrt(1 - kHorizon * kHorizon);
  return [(w[0] / flat) * side, (w[1] / flat) * side, kHorizon];
}

// Directions at all nodes, theta_h fastest, then phi_d, theta_d, phi_h; the last size asked for is kept.
let kept = {};
function nodesOf(size) {
  if (kept.size === size) return kept;
  const {thetaH, phiH = 1, thetaD, phiD} = size, count = thetaH * phiH * thetaD * phiD;
  const wi = new Float32Array(3 * count), wo = new Float32Array(3 * count);
  let at = 0;
  for (let m = 0; m < phiH; ++m)
    for (let l = 0; l < thetaD; ++l)
      for (let j = 0; j < phiD; ++j)
        for (let i = 0; i < thetaH; ++i, at += 3) {
          const [light, view] = fromHalfDiff(kHalfPi * (i / (thetaH - 1)) ** 2, (2 * Math.PI * m) / phiH,
                                             (kHalfPi * l) / (thetaD - 1), (2 * Math.PI * j) / phiD);
          wi.set(lifted(light), at);
          wo.set(lifted(view), at);
        }
  return (kept = {size, count, wi, wo});
}

// Values at all nodes, rgb.
async function tabulate(material, size, alive) {
  const {count, wi, wo} = nodesOf(size), values = new Float32Array(3 * count);
  for (let first = 0; first < count; first += kChunk) {
    const last = Math.min(first + kChunk, count), part = (all) => all.slice(3 * first, 3 * last);
    const found = toRgb(await material.evaluate(part(wi), part(wo)), material.channels);
    if (!alive()) return null;
    values.set(found, 3 * first);
  }
  return values;
}

// Stored as halves: no value is negative, unknown or too large for them.
function storable(values) {
  let largest = 0;
  for (let i = 0; i < values.length; ++i) {
    if (!(values[i] > 0)) values[i] = 0;
    if (!Number.isFinite(values[i])) values[i] = kLargestHalf;
    if (values[i] > largest) largest = values[i];
  }
  const factor = largest > 0 ? 2 ** Math.ceil(Math.log2(largest / kLargestHalf)) : 1;
  for (let i = 0; i < values.length; ++i) values[i] /= factor;
  return factor;
}

// alpha of the GGX lobe whose highlight is as wide as this one, along the tangent and across it.
async function roughness(material) {
  const steps = 60, wi = [], wo = [], tilt = Math.PI / 9;
  const angles = Array.from({length: steps}, (_, k) => kHalfPi * 0.8 * (k / (steps - 1)) ** 2);
  for (const phi of [0, kHalfPi])
    for (const theta of angles) {
      const h = direction(theta, phi), across = direction(kHalfPi, phi + kHalfPi);
      wi.push(...normalize(add(scale(h, Math.cos(tilt)), across, Math.sin(tilt))));
      wo.push(...normalize(add(scale(h, Math.cos(tilt)), across, -Math.sin(tilt))));
    }
  const values = toRgb(await material.evaluate(new Float32Array(wi), new Float32Array(wo)), material.channels);
  return [0, 1].map((axis) => {
    const at = (k) => [0, 1, 2].reduce((sum, c) => sum + values[3 * (axis * steps + k) + c], 0);
    const half = angles.findIndex((_, k) => k > 0 && at(k) < at(0) / 2);
    return half < 0 ? 0.7 : Math.min(Math.max(Math.tan(angles[half]) / 0.64, 0.008), 0.7);
  });
}

// Floats that WebGL2 would not filter are stored as halves; values are near 1.
const kFiltered = {R32F: "R16F", RGB32F: "RGB16F", RGBA32F: "RGBA16F"};

async function fromShader(gl, material) {
  const {code, textures, function: name} = await material.shader("glsl_es");
  const made = textures.map(({name: sampler, width, height, depth, data, gl: how}) => {
    const internal = gl[kFiltered[how.internalFormat] ?? how.internalFormat];
    return {name: sampler, ...texture(gl, {width, height, depth, internal, format: gl[how.format], type: gl[how.type], data})};
  });
  const glsl = `${code}\nvec3 brdf(vec3 wi, vec3 wo) { return vec3(${name}(wi, wo)); }`;
  return {glsl, textures: made, set: () => {}};
}

async function fromTable(gl, material, size, alive) {
  const values = await tabulate(material, size, alive);
  if (!values) return null;
  const factor = storable(values), {thetaH, phiH = 1, thetaD, phiD} = size;
  // isotropic: theta_d before phi_d, so that the axis which goes round is the last
  const isotropic = phiH === 1, data = isotropic ? new Float32Array(values.length) : values;
  if (isotropic)
    for (let l = 0; l < thetaD; ++l)
      for (let j = 0; j < phiD; ++j) {
        const from = 3 * thetaH * (l * phiD + j);
        data.set(values.subarray(from, from + 3 * thetaH), 3 * thetaH * (j * thetaD + l));
      }
  const shape = isotropic ? {width: thetaH, height: thetaD, depth: phiD, repeat: "r"}
                          : {width: thetaH, height: phiD, depth: phiH * thetaD, repeat: "t"};
  const made = texture(gl, {...shape, internal: gl.RGB16F, format: gl.RGB, type: gl.FLOAT, data});
  const set = ({at}) => {
    gl.uniform1f(at("brdf_scale"), factor);
    if (!isotropic) gl.uniform2f(at("brdf_slices"), phiH, thetaD);
  };
  return {glsl: kAngles + (isotropic ? kIsotropic : kAnisotropic), textures: [{name: "brdf_table", ...made}], set};
}

// Calls ready(form) with {glsl, textures, set(program), alpha} once, and again where a finer table follows. alive() says
// whether the material is still open.
export async function prepare(gl, {material, model}, alive, ready) {
  const alpha = await roughness(material);
  if (model && (material.channels === 1 || material.channels === 3)) {
    const form = await fromShader(gl, material);
    if (alive()) ready({...form, alpha});
    return;
  }
  for (const size of kSizes[material.isotropic ? "isotropic" : "anisotropic"]) {
    const form = await fromTable(gl, material, size, alive);
    if (!form) return;
    ready({...form, alpha});
  }
}
