/** Linear Rec. 709 or grey, 1/sr, without the cosine; directions are unit vectors, z the normal, x the tangent. */

/** Told what is done, one stage after the other, and a rising share of it in [0, 1]. */
export type Progress = (fraction: number, stage: string) => void;

export interface Call {
  /** Stops the work: the promise rejects with the signal's reason (an AbortError), other materials stay open. */
  signal?: AbortSignal;
}

export interface ExportCall extends Call {
  /** What the format says less than the material, a phrase each; not called where that is nothing. */
  onLosses?: (losses: string[]) => void;
}

/** Of what tells how far it is. */
export interface LongCall extends Call {
  onProgress?: Progress;
}

export interface OpenOptions extends LongCall {
  /** What errors and reports call it; by default the File's own. */
  name?: string;
  /** One channel a wavelength. */
  spectral?: boolean;
  /** The light under which spectra become RGB; by default E. */
  illuminant?: "E" | "D50" | "D65" | "A";
  /** CSV values are f_r cos(theta_i), which is divided out. */
  hasCosine?: boolean;
  hasCosineO?: boolean;
  brf?: boolean;
  /** By default true: interpolated values below zero become zero. */
  clampNegatives?: boolean;
  /** Klems and tensor trees: the back side. */
  back?: boolean;
  /** Of a file of several parts and bands; what info calls parts names them. A transmission's wo is mirrored through
   * the surface. */
  part?: "reflection-front" | "reflection-back" | "transmission-front" | "transmission-back";
  band?: string;
  /** Zemax: scale each incidence to its TIS. */
  scaleToTis?: boolean;
  /** Of a file of several materials (a book, neural encodings), the one of that name; by default the first. */
  entry?: string;
  /** Of codes of Neural Processes: their decoder, which is another file. */
  decoder?: Blob | Uint8Array | ArrayBuffer;
}

/** A file's bytes, whatever its format, or an analytic BRDF such as "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8". A model is a
 * Model, a surface a Surface. Rejects with an Error of one line, as do all others: of options that there are not
 * and of values of another kind too. The bytes are kept (a Blob need not be in memory): a worker that was stopped
 * reads them again. */
export function open(data: Uint8Array | ArrayBuffer | Blob | string, options?: OpenOptions): Promise<Material | Model | Surface>;

/** Loads and compiles the library before it is needed. */
export function preload(): Promise<void>;

/** Bytes that the open materials' worker holds, used or free; 0 where none is open. */
export function memory(): number;

export interface FitOptions {
  /** Of the model; by default the material's, "fitted". */
  name?: string;
  /** Bytes, also as a text such as "16K", or "auto"; without a budget or model 16384 within two fetches (of some nodes
   * three, anisotropic: six). */
  budget?: number | string;
  fetches?: number;
  lobes?: number;
  search?: boolean;
  loss?: "image" | "relative" | "log_cos";
  /** A product of tables, as the command line's --model. */
  model?: string;
  tables?: string[];
  /** What the owner of a measurement makes of it, or what was measured; by default the material's `target`, but
   * of one lobe and without `symmetrize` the function. */
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
  /** Of functions and files: letters, digits, single underscores. */
  name?: string;
  exact?: boolean;
  /** Of languages but C++: texels are multiplied in half precision. */
  half?: boolean;
  mips?: boolean;
  cells?: number;
  count?: number;
  seed?: number;
  entries?: boolean;
  /** Keep the fit's notes in "burnish". */
  notes?: boolean;
}

/** One file: those of the verb `convert`. "exr" is a model's own file, of others an image of slices. */
export type FileKind = "burnish" | "model" | "exr" | "merl" | "utia" | "rgl" | "mbsdf" | "zemax" | "tensortree" | "openmaterial" |
  "astm" | "csv";
/** Several files, of models: those of the verb `export`; of surfaces ktx2, dds, png, gltf, three, html and languages. */
export type FilesKind = "ktx2" | "dds" | "cube" | "png" | "gltf" | "materialx" | "usda" | "mdl" | "three" | "babylon" | "html" | Language;
export interface NamedFile { name: string; bytes: Uint8Array; }

export type Language = "glsl" | "glsl_es" | "hlsl" | "msl" | "slang" | "wgsl" | "cpp";

export interface Volume {
  /** Cells along theta_h, theta_d and phi_d. */
  size: [number, number, number];
  channels: number;
  /** [phi_d][theta_d][theta_h][channel]. Cell (x, y, z) is the value at theta_h = ((x + 1/2) / size[0])^2 pi/2,
   * theta_d = (y + 1/2) / size[1] pi/2, phi_d = (z + 1/2) / size[2] 2 pi; one beyond the horizon or unknown has the
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

/** What a measurement is interpolated from: cells of a half/difference table, [theta_h][theta_d][phi_d][channel], NaN a
 * hole, or the tables of an RGL file. */
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
  /** What a fit of it by default follows: see FitOptions. */
  readonly target: "function" | "nodes";
  /** Names of what a file of several materials holds; empty of others. */
  readonly entries: string[];
  /** The JSON of `burnish info --json`. */
  info(call?: Call): Promise<Record<string, any>>;
  /** n x 3 unit vectors each, to n x channels values; NaN where the material knows none. */
  evaluate(wi: ArrayLike<number>, wo: ArrayLike<number>, call?: Call): Promise<Float32Array>;
  /** Share reflected of light from theta_i (radians, below pi/2), n x channels; NaN where nothing is known. */
  albedo(thetas: ArrayLike<number>, options?: Call & {phi?: number}): Promise<Float32Array>;
  /** The material resampled for a 3-D texture; of an anisotropic one at one phi_h. */
  volume(cells?: {thetaH?: number; thetaD?: number; phiD?: number; phiH?: number}, call?: LongCall): Promise<Volume>;
  /** Null where the material is no such table. */
  table(call?: Call): Promise<Table | null>;
  /** In a worker of its own, which ends afterwards; several may run at once. The options are the verb's. */
  fit(options?: FitOptions, call?: LongCall): Promise<Model>;
  /** The JSON of `burnish compare --json`: a list, an object a model. */
  compare(models: Material | Material[], options?: CompareOptions, call?: Call): Promise<Record<string, any>[]>;
  images(model: Material, options?: {size?: number; symmetrize?: boolean}, call?: Call): Promise<Images>;
  export(kind: FileKind, options?: ExportOptions, call?: ExportCall): Promise<Uint8Array>;
  export(kind: FilesKind, options?: ExportOptions, call?: ExportCall): Promise<NamedFile[]>;
  /** Gives its memory back; whatever is asked of it afterwards rejects. */
  close(): void;
}

export interface ShaderOptions {
  /** burnish_NAME(wi, wo) and burnish_NAME_world(n, t, l, v). */
  name?: string;
  /** Texels are weighed by the shader, in floats (C++: always); else one filtered read a lookup. */
  exact?: boolean;
  halfProducts?: boolean;
  linesAre1d?: boolean;
}

export interface ShaderTexture {
  /** Of the uniform: a sampler2D, or where depth > 0 a sampler3D; clamp to the edge, linear (exact: nearest). */
  name: string;
  width: number;
  height: number;
  depth: number;
  channels: number;
  format: "half" | "float" | "rgb9e5" | "unorm8";
  /** [z][y][x][channel], of rgb9e5 a word a texel, ready for texImage2D or texImage3D with `gl`. */
  data: Float32Array | Uint8Array | Uint32Array;
  /** Names of WebGL2's constants. */
  gl: {internalFormat: string; format: string; type: string};
}

export interface Shader {
  language: Language;
  filter: "exact" | "hardware";
  /** Without a #version line; its textures are its only uniforms. */
  code: string;
  function: string;
  functionWorld: string;
  cost: {fetches: number; textures: number; operations: number; divisions: number; roots: number; powers: number};
  costText: string;
  textures: ShaderTexture[];
}

/** What `edit` does, in this order. */
export interface Edit {
  /** Radians by which the colours that lobes reflect turn about grey, of all or of each; three channels only. */
  hue?: number | number[];
  /** Factor of tan(theta_h / 2) in tables over theta_h, 0.1 to 10: how much wider highlights become. */
  roughness?: number;
  /** Of all lobes, or of each: a factor for all channels, or one a channel. */
  scale?: number | number[] | (number | number[])[];
  /** A Lambertian part to add: albedo / pi, one number or one a channel. */
  diffuse?: number | number[];
}

export class Model extends Material {
  /** Size as the library counts it. */
  readonly bytes: number;
  /** Filtered reads of one evaluation. */
  readonly fetches: number;
  readonly expression: string;
  /** Of what fit made: the JSON of `burnish fit --json`. */
  readonly report?: Record<string, any>;
  shader(language: Language, options?: ShaderOptions, call?: Call): Promise<Shader>;
  /** A new model; this one stays as it is. */
  edit(edit: Edit, call?: Call): Promise<Model>;
}

export interface SurfaceMap {
  /** Of the uniform, a sampler2D that repeats, linear within levels and between them. */
  name: string;
  width: number;
  height: number;
  format: "half" | "unorm8";
  /** Four components a texel, ready for texImage2D with `gl`; the largest level first. */
  levels: (Uint8Array | Uint16Array)[];
  gl: {internalFormat: string; format: string; type: string};
}

export interface SurfaceShader extends Shader {
  /** burnish_NAME_at(u, v, lod) gives a place, once a pixel, by these; burnish_NAME(wi, wo, place) its f_r, once a light. */
  maps: SurfaceMap[];
  /** Whether a place has a frame of its own: place.n is its normal. */
  framed: boolean;
  placeCost: Shader["cost"];
}

/** A model whose lobes' weights are maps. Evaluation, slices and figures are those of its mean. */
export class Surface extends Model {
  readonly width: number;
  readonly height: number;
  /** The uniform model of a place; v runs downwards. */
  place(u: number, v: number, options?: Call & {lod?: number}): Promise<Model>;
  shader(language: Language, options?: ShaderOptions, call?: Call): Promise<SurfaceShader>;
}
