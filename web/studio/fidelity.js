// Measures the difference between the drawn values and the measured ones: the psnr in decibels on spheres under three
// lights, with their brightest 3 % white. The GPU and the worker evaluate the same pairs of directions.
import {bind, program, target, texture} from "./gl.js";
import {pairsFragment, screenVertex} from "./shading.js";
import {cross, dot, normalize, toRgb} from "./vectors.js";

const kSide = 32;
const kLights = [[-0.5, 0.55, 0.7], [0.9, 0.1, -0.2], [0.1, 0.1, 1]].map(normalize);

// Returns wi, wo and the cosine to the light of each lit pixel, seen from the front.
function lit(light) {
  const pairs = [], eye = [0, 0, 1];
  for (let k = 0; k < kSide * kSide; ++k) {
    const x = (2 * ((k % kSide) + 0.5)) / kSide - 1, y = (2 * (Math.floor(k / kSide) + 0.5)) / kSide - 1, r2 = x * x + y * y;
    if (r2 > 0.98) continue;
    const n = [x, y, Math.sqrt(1 - r2)], t = normalize([n[2], 0, -n[0]]), frame = [t, cross(n, t), n];
    const [wi, wo] = [light, eye].map((w) => frame.map((axis) => dot(axis, w)));
    if (wi[2] > 0) pairs.push([wi, wo]);
  }
  return pairs;
}

// Returns rgb of each pair as the GPU draws it.
export function drawnValues(gl, form, pairs) {
  const made = program(gl, screenVertex, pairsFragment(form.glsl)), count = pairs.length, goal = target(gl, count, 1, false);
  const data = new Float32Array(8 * count);
  pairs.forEach(([wi, wo], k) => [data.set(wi, 4 * k), data.set(wo, 4 * (count + k))]);
  const places = texture(gl, {width: count, height: 2, internal: gl.RGBA32F, format: gl.RGBA, type: gl.FLOAT, data, filter: gl.NEAREST});
  gl.bindFramebuffer(gl.FRAMEBUFFER, goal.frame);
  gl.viewport(0, 0, count, 1);
  gl.disable(gl.DEPTH_TEST);
  gl.useProgram(made.handle);
  [...form.textures, {name: "pairs", ...places}].forEach((map, unit) => {
    bind(gl, unit, map);
    gl.uniform1i(made.at(map.name), unit);
  });
  form.set(made);
  const none = gl.createVertexArray();
  gl.bindVertexArray(none);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const values = new Float32Array(4 * count);
  gl.readPixels(0, 0, count, 1, gl.RGBA, gl.FLOAT, values);
  goal.free();
  gl.deleteVertexArray(none);
  gl.deleteTexture(places.handle);
  gl.deleteProgram(made.handle);
  return Float32Array.from({length: 3 * count}, (_, i) => values[4 * Math.floor(i / 3) + (i % 3)]);
}

const display = (x) => {
  const y = Math.min(Math.max(x, 0), 1);
  return y <= 0.0031308 ? 12.92 * y : 1.055 * y ** (1 / 2.4) - 0.055;
};

// Returns undefined when current() becomes false, since the form is gone then.
export async function fidelity(gl, form, material, current) {
  let squares = 0, count = 0;
  for (const pairs of kLights.map(lit)) {
    const [wi, wo] = [0, 1].map((side) => new Float32Array(pairs.flatMap((pair) => pair[side])));
    const exact = toRgb(await material.evaluate(wi, wo), material.channels);
    if (!current()) return undefined;
    const drawn = drawnValues(gl, form, pairs);
    const bright = pairs.map(([light], k) => light[2] * Math.max(...exact.subarray(3 * k, 3 * k + 3))).filter((x) => x >= 0).sort((a, b) => a - b);
    const factor = 1 / Math.max(bright[Math.floor(0.97 * (bright.length - 1))], 1e-9);
    exact.forEach((value, i) => {
      if (Number.isNaN(value)) return;
      const cosine = pairs[Math.floor(i / 3)][0][2];
      squares += (display(factor * cosine * value) - display(factor * cosine * drawn[i])) ** 2;
      ++count;
    });
  }
  return -10 * Math.log10(Math.max(squares / Math.max(count, 1), 1e-10));
}
