/** Values are linear Rec. 709 or grey, in 1/sr, without the cosine. Directions are unit vectors, z the normal, x the
 * tangent. */

/** Receives the stages of the work, one after the other, and the share of each that is done, rising in [0, 1]. */
export type Progress = (fraction: number, stage: string) => void;

export interface Call {
  /** Stops the work: the promise rejects with the signal's reason (an AbortError), other materials stay open. */
  signal?: AbortSignal;
}

export interface ExportCall extends Call {
  /** Receives what the format cannot keep of the material, one phrase for each loss. Not called without losses. */
  onLosses?: (losses: string[]) => void;
}

/** Options of a call that reports its progress. */
export interface LongCall extends Call {
  onProgress?: Progress;
}

export interface OpenOptions extends LongCall {
  /** The name in errors and reports; by default that of the File. */
  name?: string;
  /** Keeps one channel for each wavelength. */
  spectral?: boolean;
  /** The light under which spectra become RGB; by default E. */
  illuminant?: "E" | "D50" | "D65" | "A";
  /** CSV and ASTM values are f_r cos(theta_i), which is divided out. */
  hasCosine?: boolean;
  /** CSV and ASTM values are f_r cos(theta_o), which is divided out. */
  hasCosineO?: boolean;
  /** CSV and ASTM values are reflectance factors, which are divided by pi. */
  brf?: boolean;
  /** True by default: interpolated values below zero become zero. */
  clampNegatives?: boolean;
  /** Takes the back's reflection from a file with several parts. */
  back?: boolean;
  /** The part of a file with several parts and bands, which the entry parts of info lists. A transmission's wo is
   * mirrored through the surface. */
  part?: "reflection-front" | "reflection-back" | "transmission-front" | "transmission-back";
  band?: string;
  /** Scales each incidence of Zemax and LightTools files to its TIS. */
  scaleToTis?: boolean;
  /** The name of one of several materials in a file (a book, neural encodings); by default the first. */
  entry?: string;
  /** The decoder for codes of Neural Processes, which is another file. */
  decoder?: Blob | Uint8Array | ArrayBuffer;
}

/** Opens a file's bytes in any format, or an analytic BRDF such as "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8". A model
 * becomes a Model, a surface a Surface. Rejects with an Error of one line, as all functions do. Unknown options and
 * values of a wrong type are errors too. The bytes are kept (a Blob need not be in memory), since a worker that was
 * stopped reads them again. */
export function open(data: Uint8Array | ArrayBuffer | Blob | string, options?: OpenOptions): Promise<Material | Model | Surface>;

/** Loads and compiles the library before it is needed. */
export function preload(): Promise<void>;

/** Bytes that the open materials' worker holds, used or free; 0 where none is open. */
export function memory(): number;

export interface FitOptions {
  /** The name of the model; by default the material's with "fitted" behind it. */
  name?: string;
  /** The most bytes, a number or a text such as "16K", or "auto". Without a budget or model 16384 bytes within two
   * fetches (three for some nodes, six for anisotropic materials). */
  budget?: number | string;
  fetches?: number;
  lobes?: number;
  search?: boolean;
  loss?: "image" | "relative" | "log_cos";
  /** A product of tables, as the command line's --model. */
  model?: string;
  tables?: string[];
  /** Fits the function that interpolates the measured values, or nodes, the measured values alone. The default is the
   * material's `target`, but the function for one lobe and without `symmetrize`. */
  target?: "function" | "nodes";
  holdOut?: string;
  smooth?: number | "auto";
  format?: "half" | "float" | "rgb9e5" | "unorm8";
  reweightings?: number;
  floor?: number;
  samples?: number;
  seed?: number;
  symmetrize?: boolean;
  conserveEnergy?: boolean;
}

export interface CompareOptions {
  target?: "function" | "nodes";
  only?: string;
  symmetrize?: boolean;
  count?: number;
  seed?: number;
}

export interface ExportOptions {
  /** The name of functions and files: letters, digits, single underscores. */
  name?: string;
  exact?: boolean;
  /** Multiplies texels in half precision, in all languages but C++. */
  half?: boolean;
  mips?: boolean;
  cells?: number;
  count?: number;
  seed?: number;
  entries?: boolean;
  /** Keeps the fit's notes in "burnish". */
  notes?: boolean;
}

/** Exports of one file: those of the verb `convert`. "exr" is a model's own file, for other materials an image of
 * slices. */
export type FileKind = "burnish" | "model" | "exr" | "merl" | "utia" | "rgl" | "mbsdf" | "zemax" | "tensortree" | "klems" |
  "speos" | "openmaterial" | "astm" | "csv";
/** Exports of several files: for models those of the verb `export`; for OpenPBR all that need no tables; for surfaces
 * ktx2, dds, png, gltf, three, html and languages. */
export type FilesKind = "ktx2" | "dds" | "cube" | "png" | "gltf" | "materialx" | "usda" | "mdl" | "three" | "babylon" | "html" | Language;
export interface NamedFile { name: string; bytes: Uint8Array; }

export type Language = "glsl" | "glsl_es" | "hlsl" | "msl" | "slang" | "wgsl" | "cpp";

export interface Volume {
  /** Cells along theta_h, theta_d and phi_d. */
  size: [number, number, number];
  channels: number;
  /** [phi_d][theta_d][theta_h][channel]. Cell (x, y, z) is the value at theta_h = ((x + 1/2) / size[0])^2 pi/2,
   * theta_d = (y + 1/2) / size[1] pi/2, phi_d = (z + 1/2) / size[2] 2 pi. A cell beyond the horizon or unknown has the
   * nearest known value of its row along theta_d. */
  data: Float32Array;
}

export interface Images {
  size: number;
  exposure: number;
  /** RGB bytes of the three scored spheres, tone mapped, both under the reference's exposure. */
  reference: Uint8Array[];
  model: Uint8Array[];
}

/** The values that a measurement is interpolated from: cells of a half/difference table,
 * [theta_h][theta_d][phi_d][channel], NaN a hole, or the tables of an RGL file. */
export type Table =
  | {kind: "half_diff"; size: [number, number, number]; fullCircle: boolean; channels: number; data: Float32Array}
  | {kind: "rgl"; channels: number; isotropic: boolean; reduction: 1 | 2 | 4; jacobian: boolean; phi: Float32Array;
     theta: Float32Array; ndf: [number, number]; sigma: [number, number]; vndf: [number, number]; spectra: [number, number];
     data: {ndf: Float32Array; sigma: Float32Array; vndf: Float32Array; spectra: Float32Array}};

export class Material {
  readonly id: number;
  readonly name: string;
  readonly channels: number;
  readonly isotropic: boolean;
  readonly measurement: boolean;
  /** The default target of a fit: see FitOptions. */
  readonly target: "function" | "nodes";
  /** The names of the materials in a file of several; empty for other files. */
  readonly entries: string[];
  /** Returns the JSON of `burnish info --json`. */
  info(call?: Call): Promise<Record<string, any>>;
  /** Takes n x 3 unit vectors each, and returns n x channels values; NaN where the material has none. */
  evaluate(wi: ArrayLike<number>, wo: ArrayLike<number>, call?: Call): Promise<Float32Array>;
  /** Returns the share of light from theta_i (radians, below pi/2) that is reflected, n x channels; NaN where it is
   * unknown. */
  albedo(thetas: ArrayLike<number>, options?: Call & {phi?: number}): Promise<Float32Array>;
  /** Resamples the material for a 3-D texture, an anisotropic material at one phi_h. */
  volume(cells?: {thetaH?: number; thetaD?: number; phiD?: number; phiH?: number}, call?: LongCall): Promise<Volume>;
  /** Null where the material is no such table. */
  table(call?: Call): Promise<Table | null>;
  /** Fits a model in a worker of its own, which ends afterwards. Several fits may run at once. The options are those of
   * the verb `fit`. */
  fit(options?: FitOptions, call?: LongCall): Promise<Model>;
  /** Returns the JSON of `burnish compare --json`: a list with an object for each model. */
  compare(models: Material | Material[], options?: CompareOptions, call?: Call): Promise<Record<string, any>[]>;
  images(model: Material, options?: {size?: number; symmetrize?: boolean}, call?: Call): Promise<Images>;
  export(kind: FileKind, options?: ExportOptions, call?: ExportCall): Promise<Uint8Array>;
  export(kind: FilesKind, options?: ExportOptions, call?: ExportCall): Promise<NamedFile[]>;
  /** Gives the material's memory back. Its methods reject afterwards. */
  close(): void;
}

export interface ShaderOptions {
  /** The NAME of the functions burnish_NAME(wi, wo) and burnish_NAME_world(n, t, l, v). */
  name?: string;
  /** The shader interpolates texels in floats (C++: always). Otherwise each lookup is one filtered read. */
  exact?: boolean;
  halfProducts?: boolean;
  linesAre1d?: boolean;
}

export interface ShaderTexture {
  /** The name of the uniform: a sampler2D, or where depth > 0 a sampler3D; clamp to the edge, linear
   * (exact: nearest). */
  name: string;
  width: number;
  height: number;
  depth: number;
  channels: number;
  format: "half" | "float" | "rgb9e5" | "unorm8";
  /** [z][y][x][channel], for rgb9e5 one word for each texel; ready for texImage2D or texImage3D with `gl`. */
  data: Float32Array | Uint8Array | Uint32Array;
  /** Names of WebGL2's constants. */
  gl: {internalFormat: string; format: string; type: string};
}

export interface Shader {
  language: Language;
  filter: "exact" | "hardware";
  /** The source text, without a #version line. Its textures are its only uniforms. */
  code: string;
  function: string;
  functionWorld: string;
  cost: {fetches: number; textures: number; operations: number; divisions: number; roots: number; powers: number};
  costText: string;
  textures: ShaderTexture[];
}

/** The changes that `edit` makes, in this order. */
export interface Edit {
  /** Turns the colours that lobes reflect about grey by these radians: one number for all lobes, or one for each. Three
   * channels only. */
  hue?: number | number[];
  /** Makes highlights wider by this factor of tan(theta_h / 2), 0.1 to 10, in tables over theta_h. */
  roughness?: number;
  /** Scales all lobes, or each one: by a factor for all channels, or one for each channel. */
  scale?: number | number[] | (number | number[])[];
  /** Adds a Lambertian part with this albedo: one number, or one for each channel. */
  diffuse?: number | number[];
}

export class Model extends Material {
  /** Size as the library counts it. */
  readonly bytes: number;
  /** Filtered reads of one evaluation. */
  readonly fetches: number;
  readonly expression: string;
  /** For a model that fit made, the JSON of `burnish fit --json`. */
  readonly report?: Record<string, any>;
  shader(language: Language, options?: ShaderOptions, call?: Call): Promise<Shader>;
  /** Returns a new model; this one stays as it is. */
  edit(edit: Edit, call?: Call): Promise<Model>;
}

export interface SurfaceMap {
  /** The name of the uniform, a sampler2D that repeats, linear within levels and between them. */
  name: string;
  width: number;
  height: number;
  format: "half" | "unorm8";
  /** Four components for each texel, ready for texImage2D with `gl`; the largest level first. */
  levels: (Uint8Array | Uint16Array)[];
  gl: {internalFormat: string; format: string; type: string};
}

export interface SurfaceShader extends Shader {
  /** burnish_NAME_at(u, v, lod) reads a place from these maps, once for each pixel. burnish_NAME(wi, wo, place) gives
   * its f_r, once for each light. */
  maps: SurfaceMap[];
  /** True if a place has a frame of its own: place.n is its normal. */
  framed: boolean;
  placeCost: Shader["cost"];
}

/** A model whose lobes' weights are maps. Evaluation, slices and figures are those of its mean. */
export class Surface extends Model {
  readonly width: number;
  readonly height: number;
  /** Returns the uniform model of a place; v runs downwards. */
  place(u: number, v: number, options?: Call & {lod?: number}): Promise<Model>;
  shader(language: Language, options?: ShaderOptions, call?: Call): Promise<SurfaceShader>;
}
