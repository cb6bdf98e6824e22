// Computes by the library, while the view rests, light that is drawn through a table. Directions are those of the
// shader.
import {toRgb} from "./vectors.js";

export const kPasses = 16, kDirections = 2;  // of the environment, in each pixel and pass
const kPatience = 120;                       // milliseconds that other requests wait for the worker
let pace = 100;                              // pairs a millisecond

// Gathers the pairs of one part of the light: their directions, the factors of f_r, and where their pixels start.
function pairsOf(wi, wo, weights) {
  const lit = [];
  for (let k = 0; k < weights.length; k += 4)
    if (weights[k] + weights[k + 1] + weights[k + 2] > 0 && wo[k + 2] > 0) lit.push(k);
  const gathered = (from) => {
    const all = new Float32Array(3 * lit.length);
    lit.forEach((k, i) => {
      for (let c = 0; c < 3; ++c) all[3 * i + c] = from[k + c];
    });
    return all;
  };
  return {pixels: lit, wi: gathered(wi), wo: gathered(wo), weights: gathered(weights)};
}

// Adds weights times values. A pixel with an unknown direction gets no alpha.
function addLight(exact, pixels, weights, values) {
  pixels.forEach((to, i) => {
    if (Number.isNaN(values[3 * i])) exact[to + 3] = 0;
    else for (let c = 0; c < 3; ++c) exact[to + c] += weights[3 * i + c] * Math.max(values[3 * i + c], 0);
  });
}

// Returns the light of all pixels: rgb, and 1 where it is known. read(part, which) draws wi (0), wo (1) or the weights
// (2) of a part, four floats a pixel. Returns null when current() becomes false.
export async function exactLight(material, parts, read, current) {
  const wo = read(0, 1), exact = new Float32Array(wo.length);
  for (let k = 0; k < wo.length; k += 4) exact[k + 3] = wo[k + 2] > 0 ? 1 : 0;
  for (let part = 0; part < parts; ++part) {
    const pairs = pairsOf(read(part, 0), wo, read(part, 2));
    for (let first = 0, last; first < pairs.pixels.length; first = last) {
      last = first + Math.ceil(kPatience * pace);
      const began = performance.now(), at = [3 * first, 3 * last];
      const values = await material.evaluate(pairs.wi.subarray(...at), pairs.wo.subarray(...at));
      if (!current()) return null;
      pace = values.length / material.channels / (performance.now() - began);
      addLight(exact, pairs.pixels.slice(first, last), pairs.weights.subarray(...at), toRgb(values, material.channels));
    }
  }
  return exact;
}
