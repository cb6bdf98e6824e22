// Turns a material into GLSL: `vec3 brdf(vec3 wi, vec3 wo)` in the local frame, the textures that it reads, and the
// roughness of its highlight. A model or surface brings its own shader. MERL's and RGL's tables are read as they are.
// Other materials are tabulated over half/difference angles.
import {mapTexture, texture} from "./gl.js";
import {fromHalfDiff, fromRgl, kAngles} from "./gpu_exact.js";
import {add, direction, normalize, scale, toRgb} from "./vectors.js";

const kHalfPi = Math.PI / 2;
const kMaxStored = 32768;  // limit of stored values; larger ones are scaled down

// Cells of the table. theta_h is denser near the normal, and azimuths repeat. A coarse table comes first.
const kSizes = {
  isotropic: [{thetaH: 64, thetaD: 24, phiD: 16}, {thetaH: 128, thetaD: 64, phiD: 48}],
  anisotropic: [{thetaH: 48, thetaD: 16, phiD: 16, phiH: 16}, {thetaH: 80, thetaD: 24, phiD: 24, phiH: 36}],
};

const kIsotropic = `
uniform highp sampler3D brdf_table;
uniform float brdf_scale;
vec3 brdf(vec3 wi, vec3 wo) {
  if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
  vec4 a = angles(wi, wo);
  vec3 at = vec3(sqrt(a.x / kHalfPi), a.z / kHalfPi, a.w / (4.0 * kHalfPi));
  return brdf_scale * textureLod(brdf_table, at, 0.0).rgb;
}`;

// The texture filters theta_h and theta_d. The shader interpolates between slices of the two azimuths.
const kAnisotropic = `
uniform highp sampler3D brdf_table;
uniform float brdf_scale;
uniform vec2 brdf_slices;  // of phi_h, phi_d
vec3 slice(vec2 at, float phi_h, float phi_d) {
  return textureLod(brdf_table, vec3(at, (phi_h * brdf_slices.y + phi_d + 0.5) / (brdf_slices.x * brdf_slices.y)), 0.0).rgb;
}
vec3 brdf(vec3 wi, vec3 wo) {
  if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
  vec4 a = angles(wi, wo);
  vec2 at = vec2(sqrt(a.x / kHalfPi), a.z / kHalfPi);
  // slices of phi_h stand at k / count, those of phi_d at (k + 1/2) / count
  vec2 place = fract(a.yw / (4.0 * kHalfPi)) * brdf_slices + vec2(0.0, brdf_slices.y - 0.5);
  vec2 low = mod(floor(place), brdf_slices), high = mod(low + 1.0, brdf_slices), part = fract(place);
  vec3 first = mix(slice(at, low.x, low.y), slice(at, low.x, high.y), part.y);
  vec3 second = mix(slice(at, high.x, low.y), slice(at, high.x, high.y), part.y);
  return brdf_scale * mix(first, second, part.x);
}`;

// Returns rgb of all cells, theta_h fastest, then theta_d, phi_d, phi_h. Returns null where the material was closed
// meanwhile.
async function tabulate(material, {phiH = 1, ...size}, alive) {
  const count = size.thetaH * size.thetaD * size.phiD, values = new Float32Array(3 * count * phiH);
  for (let m = 0; m < phiH; ++m) {
    const {data} = await material.volume({...size, phiH: (2 * Math.PI * m) / phiH});
    if (!alive()) return null;
    values.set(toRgb(data, material.channels), 3 * count * m);
  }
  return values;
}

// Prepares values for halves: none is negative, unknown or too large. Returns the factor that they were divided by.
function storable(values) {
  let largest = 0;
  for (let i = 0; i < values.length; ++i) {
    if (!(values[i] > 0)) values[i] = 0;
    if (values[i] > largest) largest = values[i];
  }
  const factor = largest > kMaxStored ? largest / kMaxStored : 1;
  if (factor > 1) for (let i = 0; i < values.length; ++i) values[i] /= factor;
  return factor;
}

// Returns alpha of the GGX lobe whose highlight is as wide as this one, along the tangent and across it.
async function roughness(material) {
  const steps = 60, wi = [], wo = [], tilt = Math.PI / 9;
  const angles = Array.from({length: steps}, (_, k) => kHalfPi * 0.8 * (k / (steps - 1)) ** 2);
  for (const phi of [0, kHalfPi])
    for (const theta of angles) {
      const h = direction(theta, phi), across = direction(kHalfPi, phi + kHalfPi);
      wi.push(...normalize(add(scale(h, Math.cos(tilt)), across, Math.sin(tilt))));
      wo.push(...normalize(add(scale(h, Math.cos(tilt)), across, -Math.sin(tilt))));
    }
  const values = toRgb(await material.evaluate(new Float32Array(wi), new Float32Array(wo)), material.channels).map((x) => x || 0);
  return [0, 1].map((axis) => {
    const at = (k) => [0, 1, 2].reduce((sum, c) => sum + values[3 * (axis * steps + k) + c], 0);
    const half = angles.findIndex((_, k) => k > 0 && at(k) < at(0) / 2);
    return half < 0 ? 0.7 : Math.min(Math.max(Math.tan(angles[half]) / 0.64, 0.008), 0.7);
  });
}

// Floats that WebGL2 may not filter are stored as halves; values are near 1.
const kFiltered = {R32F: "R16F", RGB32F: "RGB16F", RGBA32F: "RGBA16F"};

// This code computes the terms of a pixel that all lights share: none, or a surface's place, whose texels may be
// turned.
const kUniform = `
void begin(vec2 at) {}
float facing(vec3 wi) { return wi.z; }`;
const ofSurface = (name, framed) => `
${name}_place here;
void begin(vec2 at) {
  vec2 across = dFdx(at), down = dFdy(at);
  here = ${name}_at(at.x, at.y, ${name}_lod(across.x, across.y, down.x, down.y));
}
float facing(vec3 wi) { return ${framed ? "dot(here.n, wi)" : "wi.z"}; }
vec3 brdf(vec3 wi, vec3 wo) { return vec3(${name}(wi, wo, here)); }`;

async function fromShader(gl, material) {
  const {code, textures, maps, framed, function: name} = await material.shader("glsl_es");
  const made = textures.map(({name: sampler, width, height, depth, data, gl: how}) => {
    const internal = gl[kFiltered[how.internalFormat] ?? how.internalFormat];
    return {name: sampler, ...texture(gl, {width, height, depth, internal, format: gl[how.format], type: gl[how.type], data})};
  });
  for (const map of maps ?? []) made.push({name: map.name, ...mapTexture(gl, map)});
  const call = maps ? ofSurface(name, framed) : `${kUniform}\nvec3 brdf(vec3 wi, vec3 wo) { return vec3(${name}(wi, wo)); }`;
  return {glsl: code + call, textures: made, set: () => {}, how: "shader"};
}

// Draws a measurement by its own interpolation. Returns null where the source has no such table.
async function fromTables(gl, material) {
  const table = await material.table();
  if (!table) return null;
  const form = table.kind === "rgl" ? fromRgl(gl, table) : fromHalfDiff(gl, table);
  return {...form, glsl: form.glsl + kUniform, how: "whole"};
}

async function fromTable(gl, material, size, alive) {
  const values = await tabulate(material, size, alive);
  if (!values) return null;
  const factor = storable(values), {thetaH, thetaD, phiD, phiH} = size;
  const made = texture(gl, {width: thetaH, height: thetaD, depth: phiD * (phiH ?? 1), repeat: phiH ? "" : "r",
                            internal: gl.RGB16F, format: gl.RGB, type: gl.FLOAT, data: values});
  const set = ({at}) => {
    gl.uniform1f(at("brdf_scale"), factor);
    if (phiH) gl.uniform2f(at("brdf_slices"), phiH, phiD);
  };
  return {glsl: kAngles + (phiH ? kAnisotropic : kIsotropic) + kUniform, textures: [{name: "brdf_table", ...made}], set, how: "table"};
}

// Calls ready(form) with {glsl, textures, set(program), alpha, how} once, and again where a finer table follows.
// alive() returns true while the material is open.
export async function prepare(gl, {material, model}, alive, ready) {
  const [size, ...finer] = kSizes[material.isotropic ? "isotropic" : "anisotropic"], drawn = model && (material.channels === 1 || material.channels === 3);
  // The request goes first, before other requests to the same worker.
  const own = (drawn ? fromShader(gl, material) : fromTables(gl, material)).then((form) => form ?? fromTable(gl, material, size, alive));
  const freed = () => own.then((form) => form?.textures.forEach(({handle}) => gl.deleteTexture(handle)), () => {});
  let alpha, first;
  try {
    [alpha, first] = await Promise.all([roughness(material), own]);
  } catch (error) {
    freed();
    throw error;
  }
  if (!first || !alive()) {
    freed();
    return;
  }
  ready({...first, alpha});
  if (first.how !== "table") return;
  for (const next of finer) {
    const form = await fromTable(gl, material, next, alive);
    if (!form) return;
    ready({...form, alpha});
  }
}
