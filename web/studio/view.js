// The lit object: two materials beside each other, summed over frames until the environment lighting is smooth.
import {exactLight, kDirections, kPasses} from "./exact.js";
import {fidelity} from "./fidelity.js";
import {bind, mesh, program, target, texture} from "./gl.js";
import {prepare} from "./gpu_brdf.js";
import {environments, kLights, lineFragment, objectFragment, objectVertex, offFragment, partFragment, pictureFragment, screenVertex, sumFragment} from "./shading.js";
import {knot, plane, sphere, teapot} from "./shapes.js";
import {normalize} from "./vectors.js";

const kEye = 4.6, kReach = 2.4;      // distances of the viewer and of the point lights from the middle
const kEnough = 512, kLongFrame = 40;  // samples a pixel; milliseconds after which a frame takes less
const kMaxPixels = 1.1e6;
const kPortraitPasses = 16, kPortraitSamples = 8;  // of a thumbnail
const kExposurePixels = 4e4, kExposureSamples = 8;
const kInks = [[0.03, 0.1, 0.16], [0.35, 0.85, 1]];  // of tangents: the wide stroke, the narrow stroke
const kStrokes = {sphere: 60, knot: 79, teapot: 24, plane: 7};  // vertices for each stroke: about the golden ratio of a row further on
const makers = {sphere, knot, teapot, plane};

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", {antialias: false, alpha: false, powerPreference: "high-performance"});
    if (!this.gl) throw new Error("This browser has no WebGL2, so nothing is drawn; all else works.");
    if (!this.gl.getExtension("EXT_color_buffer_float"))
      throw new Error("This GPU draws into no float textures, so nothing is drawn; all else works.");
    this.settings = {
      shape: "sphere", around: "studio", exposure: 0, curve: 0, shown: 0, divider: 0.5, factor: 5, yaw: 0.5, pitch: 0.35,
      tangents: false, lights: [{place: normalize([-0.5, 0.55, 0.7]), color: [14, 14, 14]}],
    };
    this.forms = new Map();
    this.programs = new Map();
    this.meshes = new Map();
    this.sides = [null, null];
    this.off = [null, null];  // of each side, the error of its sum: {passes, targets}
    this.chores = [];         // drawn between frames, in steps
    this.drawn = [];          // the sides in the last frame
    this.small = null;        // a small picture that is not on the screen yet
    this.samplesAFrame = 4;
    this.resolution = 1;  // 0.5 where drawing is slow
    this.whole = false;   // true while the resolution must stay
    const gl = this.gl;
    this.sum = program(gl, screenVertex, sumFragment);
    this.picture = program(gl, screenVertex, pictureFragment);
    this.lines = program(gl, objectVertex, lineFragment);
    this.part = this.takeOff = null;  // made at their first use
    this.black = texture(gl, {width: 1, height: 1, internal: gl.RGBA8, format: gl.RGBA, type: gl.UNSIGNED_BYTE, data: new Uint8Array(4)});
    this.sky = this.black;
    this.empty = gl.createVertexArray();
    this.onframe = () => {};
    this.onready = () => {};
    this.onseen = () => {};
    this.onexact = () => {};
    this.onjudged = () => {};
    this.onerror = () => {};
    new ResizeObserver(() => this.restart()).observe(canvas);
  }

  set(changes) {
    Object.assign(this.settings, changes);
    const onlyPicture = Object.keys(changes).every((name) => ["exposure", "curve", "divider", "factor"].includes(name));
    if (onlyPicture) this.ask();
    else this.restart();
  }
  // left and right are entries or null.
  show(left, right) {
    this.sides = [left, right];
    for (const entry of this.sides) if (entry) this.load(entry);
    this.restart();
  }
  forget(entry) {
    const form = this.forms.get(entry.id);
    this.forms.delete(entry.id);
    if (!form?.glsl) return;
    for (const {handle} of form.textures) this.gl.deleteTexture(handle);
    if (form.program) this.gl.deleteProgram(form.program.handle);
  }
  load(entry) {
    if (!this.forms.has(entry.id)) this.refresh(entry);
  }
  // Loads the entry's material anew. The old one is drawn until then.
  async refresh(entry) {
    const {material} = entry, known = this.forms.get(entry.id);
    this.forms.set(entry.id, known ?? {});
    const alive = () => this.forms.has(entry.id) && entry.material === material;
    try {
      await prepare(this.gl, entry, alive, (form) => {
        form.program = program(this.gl, objectVertex, objectFragment(form.glsl));
        const first = !this.formOf(entry);
        this.forget(entry);
        this.forms.set(entry.id, form);
        if (this.sides.includes(entry)) this.restart();
        // The measurement of its error waits until the entry is drawn.
        this.chores.push(this.judging(entry, form, alive));
        this.onready(entry, first);
        this.tick();
      });
    } catch (error) {
      if (alive()) this.onerror(error);
    }
  }
  *judging(entry, form, alive) {
    if (alive()) this.judge(entry, form, alive).catch((error) => alive() && this.onerror(error));
  }
  // Reports how the entry is drawn, and the difference from the measured values.
  async judge(entry, form, alive) {
    const current = () => alive() && this.forms.get(entry.id) === form;
    const decibels = form.how === "shader" ? undefined : await fidelity(this.gl, form, entry.material, current);
    if (current()) this.onjudged(entry, {how: form.how, decibels});
  }
  formOf(entry) {
    const form = entry && this.forms.get(entry.id);
    return form?.glsl ? form : null;
  }
  // Returns the largest picture's pixels a side.
  get largestPicture() {
    return this.gl.getParameter(this.gl.MAX_TEXTURE_SIZE);
  }
  // Takes rgb floats of all directions, rows from the top.
  setPicture(width, height, data) {
    const gl = this.gl;
    if (this.sky !== this.black) gl.deleteTexture(this.sky.handle);
    this.sky = texture(gl, {width, height, internal: gl.RGB16F, format: gl.RGB, type: gl.FLOAT, data, repeat: "s"});
    this.restart();
  }

  restart() {
    this.forgetSum();
    this.ask();
  }
  forgetSum() {
    this.frames = this.taken = 0;
    this.rests = null;
    this.off.forEach((off, side) => {
      if (!off?.passes) return;
      off.passes = 0;
      if (this.sides[side]) this.onexact(this.sides[side], 0);
    });
  }
  // Requests a picture, and a check that the last one is done.
  ask() {
    this.stale = true;
    this.tick();
  }
  tick() {
    this.request ??= requestAnimationFrame((time) => {
      this.request = null;
      this.frame(time);
    });
  }
  get wanted() {
    if (this.settings.around === "none") return 16;
    return this.resolution < 1 || this.whole ? kEnough / 4 : kEnough;
  }
  get settled() {
    return this.taken >= this.wanted;
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    let ratio = Math.min(window.devicePixelRatio, 2);
    ratio = Math.min(ratio, Math.sqrt(kMaxPixels / Math.max(clientWidth * clientHeight, 1)));
    ratio *= this.resolution;
    const width = Math.max(Math.round(clientWidth * ratio), 1), height = Math.max(Math.round(clientHeight * ratio), 1);
    if (this.targets && this.canvas.width === width && this.canvas.height === height) return;
    [this.canvas.width, this.canvas.height] = [width, height];
    this.targets?.forEach((t) => t.free());
    this.targets = [true, false, false, false, false].map((deep) => target(this.gl, width, height, deep));
    for (const off of this.off) off?.targets.forEach((t) => t.free());
    this.off = [null, null];
    this.forgetSum();
  }

  frame(time) {
    const gl = this.gl;
    if (gl.isContextLost()) return;
    // The last frame is still being drawn.
    if (this.fence && gl.clientWaitSync(this.fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
      this.tick();
      return;
    }
    if (this.fence) this.finished(time - this.began);
    // Thumbnails take turns with frames.
    if (this.chores.length && !this.stale && !this.choreWas) {
      if (this.chores[0].next().done) this.chores.shift();
      this.choreWas = true;
      this.tick();
      return;
    }
    this.choreWas = false;
    if (this.settled && !this.stale) {
      if (this.chores.length) this.tick();
      return;
    }
    this.stale = false;
    this.resize();
    if (!this.settled && !this.small) this.accumulate();
    this.compose(this.small);
    this.small?.free();
    this.small = null;
    this.began = time;
    this.drawn = this.sides.filter((entry, side) => this.isSeen(side) && this.formOf(entry));
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.onframe(this);
    this.tick();
  }
  // The last frame is on the screen. A frame after a pause says nothing about the pace.
  finished(took) {
    this.gl.deleteSync(this.fence);
    this.fence = null;
    for (const entry of this.drawn) this.onseen(entry);
    if (this.settled) this.rest();
    else this.measure(took);
  }
  // Adapts the samples of a frame, and at last the pixels, to the pace.
  measure(took) {
    this.pace = this.pace ? 0.8 * this.pace + 0.2 * took : took;
    if (took > kLongFrame && this.samplesAFrame > 2) this.samplesAFrame /= 2;
    else if (took > 4 * kLongFrame && this.resolution > 0.5 && !this.whole) this.resolution = 0.5;
    else if (took < kLongFrame / 2) this.samplesAFrame = Math.min(this.samplesAFrame * 2, 32);
  }

  // Adds a frame of each material to its sum.
  accumulate() {
    const [frame, ...sums] = this.targets, count = this.samplesAFrame;
    const jitter = jitterOf(this.frames);
    this.sides.forEach((entry, side) => {
      if (!this.isSeen(side)) return;
      const old = sums[2 * side + (this.frames % 2)], next = sums[2 * side + 1 - (this.frames % 2)];
      this.drawObject(this.formOf(entry), frame, jitter, this.taken, count);
      this.into(next, this.sum, ({at}) => {
        bind(this.gl, 0, old.color);
        bind(this.gl, 1, frame.color);
        this.gl.uniform1i(at("before"), 0);
        this.gl.uniform1i(at("frame"), 1);
        this.gl.uniform1f(at("share"), 1 / (this.frames + 1));
      });
    });
    this.frames += 1;
    this.taken += this.settings.around === "none" ? 1 : count;
  }

  // While the view rests, the library computes the light that was drawn through a table.
  async rest() {
    if (this.rests) return;
    const rests = (this.rests = {}), materials = this.sides.map((entry) => entry?.material);
    const current = () => this.rests === rests && this.sides.every((entry, side) => entry?.material === materials[side]);
    try {
      for (let pass = 0; pass < kPasses; ++pass)
        for (const side of [0, 1]) {
          if (!this.isSeen(side) || this.formOf(this.sides[side])?.how !== "table") continue;
          await this.computePass(side, pass, current);
          if (!current()) return;
        }
    } catch (error) {
      if (current()) this.onerror(error);
    }
  }
  async computePass(side, pass, current) {
    const gl = this.gl, entry = this.sides[side], form = this.formOf(entry), [frame] = this.targets, {width, height} = frame;
    const {lights, around} = this.settings, directions = around === "none" ? 0 : kDirections, parts = lights.length + directions;
    this.part ??= program(gl, objectVertex, partFragment);
    this.takeOff ??= program(gl, screenVertex, offFragment);
    this.off[side] ??= {passes: 0, targets: [0, 1].map(() => target(gl, width, height, false))};
    const material = entry.material, plain = {...form, textures: [], set: () => {}};
    const read = (part, which) => {
      const pixels = new Float32Array(4 * width * height);
      gl.useProgram(this.part.handle);
      gl.uniform1i(this.part.at("part"), part);
      gl.uniform1i(this.part.at("which"), which);
      this.drawObject(plain, frame, jitterOf(pass), directions * pass, directions, this.part);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
      return pixels;
    };
    const data = await exactLight(material, parts, read, current);
    if (!data) return;
    const off = this.off[side], [before, next] = [off.targets[off.passes % 2], off.targets[1 - (off.passes % 2)]];
    const exact = texture(gl, {width, height, internal: gl.RGBA32F, format: gl.RGBA, type: gl.FLOAT, data, filter: gl.NEAREST});
    this.drawObject(form, frame, jitterOf(pass), directions * pass, directions);
    this.into(next, this.takeOff, ({at}) => {
      [before.color, frame.color, exact].forEach((map, unit) => {
        bind(gl, unit, map);
        gl.uniform1i(at(["before", "frame", "exact"][unit]), unit);
      });
      gl.uniform1f(at("share"), 1 / (pass + 1));
    });
    gl.deleteTexture(exact.handle);
    off.passes = pass + 1;
    this.onexact(entry, off.passes / kPasses);
    this.ask();
  }

  isSeen(side) {
    const {shown} = this.settings;
    return side === 0 ? shown !== 1 || !this.sides[1] : this.sides[1] !== null && shown !== 0;
  }

  into(goal, made, set) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, goal ? goal.frame : null);
    gl.viewport(0, 0, goal?.width ?? this.canvas.width, goal?.height ?? this.canvas.height);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(made.handle);
    set(made);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  place({at}, goal, jitter) {
    const gl = this.gl, {yaw, pitch} = this.settings, least = Math.min(goal.width, goal.height);
    const c = Math.cos(yaw), s = Math.sin(yaw), d = Math.cos(pitch), e = Math.sin(pitch);
    gl.uniformMatrix3fv(at("turn"), false, [c, s * e, -s * d, 0, d, e, s, -c * e, c * d]);
    const zoom = 0.86 * Math.sqrt(kEye * kEye - 1);
    gl.uniform2f(at("zoom"), (zoom * least) / goal.width, (zoom * least) / goal.height);
    gl.uniform2f(at("jitter"), (2 * jitter[0]) / goal.width, (2 * jitter[1]) / goal.height);
    gl.uniform1f(at("eye"), kEye);
  }

  drawObject(form, goal, jitter, first, count, made = form?.program) {
    const gl = this.gl, {shape} = this.settings;
    gl.bindFramebuffer(gl.FRAMEBUFFER, goal.frame);
    gl.viewport(0, 0, goal.width, goal.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!form) return;
    gl.useProgram(made.handle);
    this.place(made, goal, jitter);
    this.setLight(form, made);
    gl.uniform1i(made.at("samples"), count);
    gl.uniform1i(made.at("first_sample"), first);
    // Depths are drawn first, so that hidden parts cost nothing.
    gl.colorMask(false, false, false, false);
    gl.useProgram(this.lines.handle);
    this.place(this.lines, goal, jitter);
    gl.uniform1f(this.lines.at("lift"), 0);
    this.drawMesh(shape);
    gl.colorMask(true, true, true, true);
    gl.useProgram(made.handle);
    gl.depthFunc(gl.LEQUAL);
    this.drawMesh(shape);
  }

  // Sets the form's textures, the lights and the environment.
  setLight(form, {at}) {
    const gl = this.gl, {lights, around} = this.settings;
    form.textures.forEach((map, unit) => {
      bind(gl, unit, map);
      gl.uniform1i(at(map.name), unit);
    });
    bind(gl, form.textures.length, this.sky);
    gl.uniform1i(at("picture"), form.textures.length);
    form.set({at});
    gl.uniform1i(at("around"), environments.indexOf(around));
    gl.uniform1i(at("light_count"), lights.length);
    const places = new Float32Array(3 * kLights), colors = new Float32Array(3 * kLights);
    lights.forEach(({place, color}, k) => {
      places.set(place.map((x) => kReach * x), 3 * k);
      colors.set(color, 3 * k);
    });
    gl.uniform3fv(at("lights"), places);
    gl.uniform3fv(at("colors"), colors);
    // Both sides draw the same directions, so that their difference has no noise.
    gl.uniform2f(at("alpha"), ...(this.formOf(this.sides[0]) ?? form).alpha);
  }

  drawMesh(shape) {
    if (!this.meshes.has(shape)) this.meshes.set(shape, mesh(this.gl, makers[shape]()));
    const {array, count} = this.meshes.get(shape);
    this.gl.bindVertexArray(array);
    this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, 0);
  }

  // Draws the sums as a picture, or a small picture of the left object.
  compose(small) {
    const gl = this.gl, {exposure, curve, shown, divider, factor, tangents} = this.settings, {width, height} = this.canvas;
    const sums = [0, 1].map((side) => this.targets[1 + 2 * side + (this.frames % 2)].color);
    const off = this.off.map((is) => (is?.passes ? is.targets[is.passes % 2].color : this.black));
    this.into(null, this.picture, ({at}) => {
      (small ? [small.color, this.black, this.black, this.black] : [...sums, ...off]).forEach((map, unit) => {
        bind(gl, unit, map);
        gl.uniform1i(at(["left", "right", "left_off", "right_off"][unit]), unit);
      });
      gl.uniform2f(at("shrunk"), small ? small.width / width : 1, small ? small.height / height : 1);
      gl.uniform1f(at("exposure"), 2 ** exposure);
      gl.uniform1i(at("curve"), curve);
      gl.uniform1i(at("shown"), this.sides[1] && !small ? shown : 0);
      gl.uniform1f(at("divider"), divider * this.canvas.width);
      gl.uniform1f(at("factor"), factor);
      gl.uniform3fv(at("background"), this.background ?? [0.1, 0.1, 0.1]);
    });
    if (tangents) this.drawTangents();
  }

  // Draws a stroke along the tangent, on a darker one, at every few vertices. The object's depth hides it.
  drawTangents() {
    const gl = this.gl, {shape} = this.settings, name = `${shape} tangents`;
    if (!this.meshes.has(name)) {
      this.meshes.set(name, mesh(gl, strokes(makers[shape]().vertices, kStrokes[shape])));
    }
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.lines.handle);
    this.place(this.lines, this.canvas, [0, 0]);
    gl.uniform1f(this.lines.at("lift"), 0);
    gl.colorMask(false, false, false, false);
    this.drawMesh(shape);
    gl.colorMask(true, true, true, true);
    kInks.forEach((ink, k) => {
      gl.uniform3fv(this.lines.at("ink"), ink);
      gl.uniform1f(this.lines.at("lift"), 0.006 + 0.003 * k);
      const {array, count} = this.meshes.get(name);
      gl.bindVertexArray(array);
      gl.drawElements(gl.TRIANGLES, count / 2, gl.UNSIGNED_INT, 4 * k * (count / 2));
    });
  }

  // Returns the exposure, in stops, that takes all but the brightest 3 % of the left object to white. A small picture
  // gives it. Where nothing has been seen yet, this picture is shown before larger ones.
  autoExposure() {
    const gl = this.gl, form = this.formOf(this.sides[0]), {clientWidth, clientHeight} = this.canvas;
    if (!form || !clientWidth || !clientHeight) return null;
    const shrunk = Math.min(Math.sqrt(kExposurePixels / (clientWidth * clientHeight)), 1);
    const [width, height] = [clientWidth, clientHeight].map((side) => Math.max(Math.round(shrunk * side), 1));
    const goal = target(gl, width, height, true), pixels = new Float32Array(4 * width * height);
    this.drawObject(form, goal, [0, 0], 0, kExposureSamples);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    const seen = this.sides[1] || this.drawn.includes(this.sides[0]);
    this.small?.free();
    this.small = seen ? null : goal;
    if (seen) goal.free();
    else this.stale = true;
    return exposureOf(pixels);
  }

  // Draws a small picture of a sphere under the studio's light, between frames.
  thumbnail(entry, size, told) {
    this.chores.push(this.portrait(entry, size, told));
    this.tick();
  }
  *portrait(entry, size, told) {
    const gl = this.gl, form = this.formOf(entry), studio = {shape: "sphere", around: "studio", yaw: 0, pitch: 0, lights: []};
    const sums = new Float32Array(4 * size * size), pixels = new Float32Array(4 * size * size);
    // The picture is shown at once, and again each time that twice as many passes are done.
    for (let pass = 0; pass < kPortraitPasses; ++pass) {
      if (this.formOf(entry) !== form) return;
      const {settings, sides} = this, goal = target(gl, size, size, true);
      this.sides = [entry, null];
      this.settings = {...settings, ...studio};
      this.drawObject(form, goal, jitterOf(pass), kPortraitSamples * pass, kPortraitSamples);
      [this.settings, this.sides] = [settings, sides];
      gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, pixels);
      goal.free();
      for (let k = 0; k < sums.length; ++k) sums[k] += (pixels[k] - sums[k]) / (pass + 1);
      if ((pass & (pass + 1)) === 0) told(thumbnailOf(sums, size));
      yield;
    }
  }

  // Returns the present picture with all pixels of the screen. Where drawing is slow, it is drawn again for this.
  async png(signal) {
    const {resolution} = this;
    if (resolution < 1) await this.drawWhole(signal);
    this.compose();
    const made = new Promise((done) => this.canvas.toBlob(done, "image/png"));
    if (resolution < 1) [this.whole, this.resolution] = [false, resolution];
    return made;
  }
  async drawWhole(signal) {
    const before = this.resolution, computed = this.computed;
    [this.whole, this.resolution] = [true, 1];
    this.restart();
    while (!this.settled || this.stale || (computed && !this.computed)) {
      await new Promise((next) => setTimeout(next, 20));
      if (!signal?.aborted) continue;
      [this.whole, this.resolution] = [false, before];
      this.restart();
      throw signal.reason;
    }
  }
  // Returns true if the library computed the light that is drawn through tables.
  get computed() {
    return this.sides.every((entry, side) => !this.isSeen(side) || this.formOf(entry)?.how !== "table" || this.off[side]?.passes === kPasses);
  }
}

// Returns strokes along the tangents of every few vertices: first the wide ones, then as many narrow ones.
function strokes(vertices, every) {
  const made = [], indices = [];
  for (const [length, width] of [[0.041, 0.011], [0.035, 0.005]])
    for (let k = 0; k < vertices.length / 9; k += every) {
      const p = vertices.slice(9 * k, 9 * k + 3), n = vertices.slice(9 * k + 3, 9 * k + 6), t = vertices.slice(9 * k + 6, 9 * k + 9);
      const across = [n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]], first = made.length / 9;
      for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1]])
        made.push(...p.map((x, i) => x + a * length * t[i] + b * width * across[i]), ...n, ...t);
      indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  return {vertices: made, indices};
}

const fract = (x) => x - Math.floor(x);
const jitterOf = (k) => [fract(k * 0.7548776662 + 0.5) - 0.5, fract(k * 0.569840291 + 0.5) - 0.5];

// Returns a square picture for a canvas, from rows that start below, with an exposure of its own.
function thumbnailOf(sums, size) {
  const factor = 2 ** exposureOf(sums), image = new ImageData(size, size);
  for (let y = 0; y < size; ++y)
    for (let x = 0; x < size; ++x) {
      const from = 4 * ((size - 1 - y) * size + x), to = 4 * (y * size + x), cover = sums[from + 3];
      for (let c = 0; c < 3; ++c) image.data[to + c] = 255 * Math.min(factor * sums[from + c] / Math.max(cover, 1e-6), 1) ** (1 / 2.2);
      image.data[to + 3] = 255 * cover;
    }
  return image;
}

function exposureOf(pixels) {
  const values = [];
  for (let k = 0; k < pixels.length; k += 4)
    if (pixels[k + 3] > 0.99) values.push(Math.max(pixels[k], pixels[k + 1], pixels[k + 2]));
  if (!values.length) return 0;
  values.sort((a, b) => a - b);
  const bright = values[Math.floor(0.97 * (values.length - 1))];
  return bright > 0 ? Math.min(Math.max(Math.log2(1 / bright), -12), 12) : 0;
}
