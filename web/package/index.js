// burnish: measured BRDFs in the browser and in Node. README.md shows its use, index.d.ts declares it.

const inNode = typeof process === "object" && Boolean(process.versions?.node);

async function read(name) {
  const response = await fetch(new URL(`./${name}`, import.meta.url));
  if (!response.ok) throw new Error(`${name}: expected the library's code, found status ${response.status}`);
  return response;
}

// Returns make()'s result: made once, and again after a failure.
function once(make) {
  let made;
  return () => {
    made ??= make();
    made.catch(() => { made = undefined; });
    return made;
  };
}

// Returns the library's code, once for all workers, with `threads` beside each worker's own.
function codeFor(threads) {
  const name = threads > 0 ? "burnish-threads" : "burnish";
  // In browsers, scripts of workers and threads have the library's glue inside, so none asks for a file later.
  // `replaced` is a pattern that must be there; `by` takes its place.
  const glue = once(async () => (await read(`${name}.js`)).text());
  const script = (...parts) => URL.createObjectURL(new Blob(parts, {type: "text/javascript"}));
  const withGlue = async (file, replaced, by) => {
    const [before, text] = await Promise.all([glue(), read(file).then((response) => response.text())]);
    if (!replaced.test(text)) throw new Error(`${file}: expected the code that loads the library, found none`);
    return script(before.replace(/export default burnish_wasm;/, ""), text.replace(replaced, by));
  };
  const imported = /\(e\.data\.urlOrBlob\?import\(.*?\):import\(.*?\)\)/;
  // From Emscripten 3.1.58 on, threads run the glue too.
  const threadCode = async () => (await glue()).includes("em-pthread")
    ? script(await glue())
    : withGlue(`${name}.worker.js`, imported, "Promise.resolve({default: burnish_wasm})");
  return {
    threads,
    module: once(async () => {
      const file = `${name}.wasm`;
      if (!inNode) return WebAssembly.compile(await (await read(file)).arrayBuffer());
      return WebAssembly.compile(await (await import("node:fs/promises")).readFile(new URL(file, import.meta.url)));
    }),
    worker: once(async () => inNode
      ? new URL("./worker.js", import.meta.url)
      : withGlue("worker.js", /^import createLibrary .*$/m, "const createLibrary = burnish_wasm;")),
    thread: once(async () => (threads > 0 ? threadCode() : undefined)),
  };
}

// Threads run where pages may share memory between workers, on at most this many processors.
const kMaxThreads = 8;
const sharesMemory = !inNode && globalThis.crossOriginIsolated;
let code = codeFor(sharesMemory ? Math.min(navigator.hardwareConcurrency ?? 1, kMaxThreads) - 1 : 0);

// Returns use(code). Where threads cannot be had after all, it uses the code without them.
async function withCode(use) {
  const tried = code;
  try {
    return await use(tried);
  } catch (error) {
    if (tried.threads === 0) throw error;
    if (code === tried) code = codeFor(0);
    return use(code);
  }
}

const loaded = (of) => Promise.all([of.module(), of.worker(), of.thread()]);

function newWorker(receive, fail) {
  return withCode(async (of) => {
    const [module, url, threadCode] = await loaded(of);
    const worker = inNode ? new (await import("node:worker_threads")).Worker(url) : new Worker(url, {type: "module"});
    try {
      await new Promise((started, failed) => {
        const first = ({error}) => error === undefined ? started() : failed(new Error(error));
        const broken = (error) => failed(error instanceof Error ? error : new Error(error.message ?? "the worker could not be started"));
        if (inNode) worker.once("message", first).once("error", broken);
        else Object.assign(worker, {onmessage: (event) => first(event.data), onerror: broken});
        worker.postMessage({module, threads: of.threads, threadCode});
      });
    } catch (error) {
      worker.terminate();
      throw error;
    }
    if (inNode) worker.on("message", receive).on("error", fail);
    else Object.assign(worker, {onmessage: (event) => receive(event.data), onerror: (event) => fail(new Error(event.message ?? "the worker stopped"))});
    return worker;
  });
}

const aborted = (signal) => signal.reason ?? new DOMException("The operation was aborted.", "AbortError");

// One worker and its queue of jobs. A job sends the materials that it needs, again where the worker was stopped.
class Engine {
  #worker;
  #known = new Set();
  #jobs = [];
  #running = false;
  #calls = 0;
  #stops = 0;
  #waiting;
  memory = 0;  // bytes of the library in the worker

  /// Turns {request, bytes?, materials?, onProgress?, signal?} into {json, blobs, memory}.
  run(job) {
    const {signal, onProgress} = job;
    if (onProgress !== undefined && typeof onProgress !== "function") return Promise.reject(new Error(`expected onProgress as a function, found ${kindOf(onProgress)}`));
    if (signal !== undefined && !(signal instanceof AbortSignal)) return Promise.reject(new Error(`expected signal as an AbortSignal, found ${kindOf(signal)}`));
    if (signal?.aborted) return Promise.reject(aborted(signal));
    return new Promise((resolve, reject) => {
      const entry = {job, resolve, reject};
      entry.abort = () => {
        const place = this.#jobs.indexOf(entry);
        if (place >= 0) this.#jobs.splice(place, 1);
        else this.stop();
        entry.stopped = true;
        reject(aborted(signal));
      };
      signal?.addEventListener("abort", entry.abort, {once: true});
      this.#jobs.push(entry);
      this.#next();
    });
  }

  /// Ends the worker at once, and frees its memory.
  stop() {
    ++this.#stops;
    this.#worker?.terminate();
    this.#worker = undefined;
    this.memory = 0;
    this.#known.clear();
    this.#waiting?.reject(new Error("the worker was stopped"));
    this.#waiting = undefined;
  }

  /// Forgets a material once its requests are answered.
  close(id) {
    if (!this.#running && !this.#known.has(id)) return;
    if (!this.#running && this.#known.size === 1) this.stop();
    else this.run({request: {verb: "close", id}}).catch(() => {});
  }
  // Returns true if the worker must be told. With the last material, it ends instead.
  #forgets(id) {
    return this.#known.delete(id) && (this.#known.size > 0 || this.#jobs.length > 0);
  }

  async #next() {
    if (this.#running) return;
    this.#running = true;
    while (this.#jobs.length > 0) {
      const entry = this.#jobs.shift(), {job} = entry;
      try {
        for (const material of job.materials ?? []) {
          if (entry.stopped) break;
          if (!this.#known.has(material.id)) await this.#call({request: material.request, bytes: await material.bytes()});
          this.#known.add(material.id);
        }
        if (job.request.verb === "close" && !this.#forgets(job.request.id)) {
          entry.resolve();
        } else if (!entry.stopped) {
          const reply = await this.#call(job, job.onProgress);
          if (job.request.verb === "open") this.#known.add(job.request.id);
          entry.resolve(reply);
        }
      } catch (error) {
        entry.reject(error);
      }
      job.signal?.removeEventListener("abort", entry.abort);
    }
    this.#running = false;
    if (this.#known.size === 0) this.stop();
    else if (inNode) this.#worker?.unref();
  }

  async #call({request, bytes}, onProgress) {
    if (!this.#worker) {
      const stops = this.#stops;
      const worker = await newWorker((message) => this.#worker === worker && this.#receive(message),
                                     (error) => this.#worker === worker && this.#fail(error));
      if (stops !== this.#stops) {  // stopped during its start
        worker.terminate();
        throw new Error("the worker was stopped");
      }
      this.#worker = worker;
    }
    if (inNode) this.#worker.ref();
    const call = ++this.#calls;
    return new Promise((resolve, reject) => {
      this.#waiting = {call, resolve, reject, onProgress};
      // The bytes are moved, not copied: they were made for this call.
      this.#worker.postMessage({call, request, bytes}, bytes ? [bytes] : []);
    });
  }

  #receive({call, progress, reply, error, fatal}) {
    const waiting = this.#waiting;
    if (waiting?.call !== call) return;
    if (progress) {
      waiting.onProgress?.(progress.fraction, progress.stage);
      return;
    }
    this.#waiting = undefined;
    if (fatal) this.stop();
    this.memory = reply?.memory ?? this.memory;
    if (error !== undefined) waiting.reject(new Error(error));
    else waiting.resolve(reply);
  }

  #fail(error) {
    const waiting = this.#waiting;
    this.#waiting = undefined;
    this.stop();
    waiting?.reject(error instanceof Error ? error : new Error(String(error)));
  }
}

// One worker answers questions. A fit takes seconds and memory, so it has a worker of its own.
const answers = new Engine();

let ids = 0;

const floats = (buffer) => new Float32Array(buffer);

// Describes a wrong argument.
const kindOf = (value) => value === null || value === undefined ? String(value) : value.constructor?.name ?? typeof value;
const isList = (value) => typeof value === "object" && Number.isInteger(value?.length) && (value.length === 0 || typeof value[0] === "number");
function expectOptions(verb, ...all) {
  for (const value of all)
    if (typeof value !== "object" || value === null) throw new Error(`${verb}: expected options, found ${kindOf(value)}`);
}
function expectMaterial(verb, value) {
  if (!(value instanceof Material)) throw new Error(`${verb}: expected a material, found ${kindOf(value)}`);
}
function expectBytes(value, what) {
  if (value instanceof Blob || value instanceof ArrayBuffer || ArrayBuffer.isView(value)) return;
  throw new Error(`open: expected ${what}, found ${kindOf(value)}`);
}

export class Material {
  #recipe;
  #closed = false;

  /// open and fit make models.
  constructor(recipe, summary) {
    this.#recipe = recipe;
    this.id = recipe.id;
    this.name = summary.name;
    this.channels = summary.channels;
    this.isotropic = summary.isotropic;
    this.measurement = summary.measurement;
    this.target = summary.target;
    this.entries = summary.entries ?? [];
  }

  /// The recipe serves methods of this file.
  get recipe() {
    if (this.#closed) throw new Error(`${this.name}: expected an open material, found one that was closed`);
    return this.#recipe;
  }

  // Sends the caller's `options` and `call` with the further arguments.
  async #ask(verb, options, call, {bytes, others = [], more} = {}) {
    expectOptions(verb, options, call);
    const {onProgress, signal} = call;
    return answers.run({
      request: {...options, ...more, verb, id: this.id},
      materials: [this.recipe, ...others.map((other) => other.recipe)],
      bytes, onProgress, signal,
    });
  }

  async info(call = {}) {
    return (await this.#ask("info", {}, call)).json;
  }

  async evaluate(wi, wo, call = {}) {
    if (!isList(wi) || !isList(wo) || wi.length !== wo.length || wi.length % 3 !== 0)
      throw new Error("evaluate: expected as many wi as wo, three numbers each in one list");
    const both = new Float32Array(2 * wi.length);
    both.set(wi);
    both.set(wo, wi.length);
    return floats((await this.#ask("evaluate", {}, call, {bytes: both.buffer})).blobs[0]);
  }

  async albedo(thetas, options = {}) {
    expectOptions("albedo", options);
    const {phi = 0, signal} = options;
    if (!isList(thetas)) throw new Error(`albedo: expected a list of angles, found ${kindOf(thetas)}`);
    return floats((await this.#ask("albedo", {phi}, {signal}, {bytes: Float32Array.from(thetas).buffer})).blobs[0]);
  }

  async volume(cells = {}, call = {}) {
    expectOptions("volume", cells);
    const {thetaH = 90, thetaD = 90, phiD = 180, phiH = 0} = cells;
    const {json, blobs} = await this.#ask("volume", {thetaH, thetaD, phiD, phiH}, call);
    return {...json, data: floats(blobs[0])};
  }

  async table(call = {}) {
    const {json, blobs} = await this.#ask("table", {}, call);
    if (!json) return null;
    const values = blobs.map(floats);
    if (json.kind === "half_diff") return {...json, data: values[0]};
    const [phi, theta, ndf, sigma, vndf, spectra] = values;
    return {...json, phi, theta, data: {ndf, sigma, vndf, spectra}};
  }

  async compare(models, options = {}, call = {}) {
    const several = Array.isArray(models) ? models : [models];
    several.forEach((model) => expectMaterial("compare", model));
    const {json} = await this.#ask("compare", options, call, {others: several, more: {models: several.map((m) => m.id)}});
    return json;
  }

  async images(model, options = {}, call = {}) {
    expectMaterial("images", model);
    const {json, blobs} = await this.#ask("images", options, call, {others: [model], more: {model: model.id}});
    const pictures = blobs.map((blob) => new Uint8Array(blob));
    return {...json, reference: pictures.slice(0, pictures.length / 2), model: pictures.slice(pictures.length / 2)};
  }

  async fit(options = {}, call = {}) {
    expectOptions("fit", options, call);
    const {name = `${this.name} fitted`, ...how} = options, {onProgress, signal} = call;
    if (typeof name !== "string") throw new Error(`fit: expected a name as a text, found ${kindOf(name)}`);
    const engine = new Engine(), request = {verb: "fit", id: this.id, name, options: how};
    // Ending the worker frees its memory, which never shrinks.
    const {json, blobs} = await engine.run({request, materials: [this.recipe], onProgress, signal}).finally(() => engine.stop());
    return open(new Blob([blobs[0]]), {name, report: json, signal});
  }

  /// Returns one file's bytes, or a list of files where there are several.
  async export(kind, options = {}, call = {}) {
    expectOptions("export", options, call);
    const {onLosses} = call;
    if (onLosses !== undefined && typeof onLosses !== "function") throw new Error(`export: expected onLosses as a function, found ${kindOf(onLosses)}`);
    const {json, blobs} = await this.#ask("export", options, call, {more: {kind}});
    if (json.losses?.length) onLosses?.(json.losses);
    if (kConverted.has(kind)) return new Uint8Array(blobs[0]);
    return json.names.map((name, i) => ({name, bytes: new Uint8Array(blobs[i])}));
  }

  close() {
    if (this.#closed) return;
    this.#closed = true;
    answers.close(this.id);
  }
}

const kConverted = new Set(["merl", "utia", "rgl", "mbsdf", "zemax", "tensortree", "klems", "speos", "openmaterial", "astm", "csv", "exr", "model", "burnish"]);

// WebGL2's [internal format, format, type] for texels of a format, by channels.
const kTexels = {
  half: {1: ["R16F", "RED", "FLOAT"], 3: ["RGB16F", "RGB", "FLOAT"]},
  float: {1: ["R32F", "RED", "FLOAT"], 3: ["RGB32F", "RGB", "FLOAT"]},
  rgb9e5: {3: ["RGB9_E5", "RGB", "UNSIGNED_INT_5_9_9_9_REV"]},
  unorm8: {1: ["R8", "RED", "UNSIGNED_BYTE"], 3: ["RGB8", "RGB", "UNSIGNED_BYTE"]},
};

export class Model extends Material {
  constructor(recipe, summary, report) {
    super(recipe, summary);
    this.bytes = summary.bytes;
    this.fetches = summary.fetches;
    this.expression = summary.expression;
    this.report = report;
  }

  async edit(edit, call = {}) {
    expectOptions("edit", edit, call);
    const {signal} = call;
    const {blobs} = await answers.run({
      request: {verb: "edit", id: this.id, edit}, materials: [this.recipe], signal,
    });
    return open(new Blob([blobs[0]]), {name: `${this.name} edited`, signal});
  }

  async shader(language, options = {}, call = {}) {
    expectOptions("shader", options, call);
    const {signal} = call;
    const {json, blobs} = await answers.run({
      request: {...options, language, verb: "shader", id: this.id}, materials: [this.recipe], signal,
    });
    const textures = json.textures.map((texture, i) => {
      const [internalFormat, format, type] = kTexels[texture.format][texture.channels];
      const data = texture.format === "rgb9e5" ? new Uint32Array(blobs[i]) :
        texture.format === "unorm8" ? Uint8Array.from(floats(blobs[i]), (v) => Math.round(255 * v)) : floats(blobs[i]);
      return {...texture, data, gl: {internalFormat, format, type}};
    });
    return {...json, textures, ...(json.maps && {maps: mapsOf(json.maps, blobs.slice(textures.length))})};
  }
}

// Returns maps with the texels of their levels, the largest first.
function mapsOf(maps, blobs) {
  let next = 0;
  return maps.map(({levels, ...map}) => {
    const half = map.format === "half", data = blobs.slice(next, (next += levels));
    const [internalFormat, type] = half ? ["RGBA16F", "HALF_FLOAT"] : ["RGBA8", "UNSIGNED_BYTE"];
    return {...map, levels: data.map((level) => (half ? new Uint16Array(level) : new Uint8Array(level))), gl: {internalFormat, format: "RGBA", type}};
  });
}

/// Questions about a model are answered for the mean. info, shader and export are those of the surface.
export class Surface extends Model {
  constructor(recipe, summary) {
    super(recipe, summary);
    this.width = summary.surface.width;
    this.height = summary.surface.height;
  }

  async place(u, v, options = {}) {
    expectOptions("place", options);
    const {lod = 0, signal} = options;
    const {blobs} = await answers.run({
      request: {verb: "place", id: this.id, u, v, lod}, materials: [this.recipe], signal,
    });
    return open(new Blob([blobs[0]]), {name: `${this.name} at ${u.toFixed(3)}, ${v.toFixed(3)}`, signal});
  }
}

/// Opens a file's bytes in any format, or an analytic BRDF such as "ggx:alpha_x=0.2,alpha_y=0.2".
export async function open(data, how = {}) {
  expectOptions("open", how);
  const {name, report, decoder, onProgress, signal, ...options} = how;
  const id = ++ids, request = {...options, verb: "open", id};
  const recipe = {id, request, bytes: async () => undefined};
  if (typeof data === "string") {
    request.spec = data;
  } else {
    expectBytes(data, "bytes, a Blob or the text of an analytic BRDF");
    if (decoder) expectBytes(decoder, "a decoder as bytes or a Blob");
    // A Blob need not be in memory.
    const blob = data instanceof Blob ? data : new Blob([data]);
    request.name = name ?? data.name ?? "file";
    if (decoder) request.decoderAt = blob.size;
    const whole = decoder ? new Blob([blob, decoder]) : blob;
    recipe.bytes = () => whole.arrayBuffer();
  }
  onProgress?.(0, "reading");
  const bytes = await recipe.bytes();
  onProgress?.(0.5, "parsing");
  const {json} = await answers.run({request, bytes, signal});
  onProgress?.(1, "opened");
  if (json.surface) return new Surface(recipe, json);
  return json.model ? new Model(recipe, json, report) : new Material(recipe, json);
}

/// Loads and compiles the library before it is needed.
export async function preload() {
  await withCode(loaded);
}

/// Bytes that the open materials' worker holds, used or free; 0 where none is open.
export function memory() {
  return answers.memory;
}
