// node frames.mjs PROGRAM FOLDER: the tangent frames of PROGRAM (burnish_mesh_frames) beside those of MikkTSpace (npm's
// mikktspace), corner by corner, for the built-in meshes and for a mesh with mirrored and torn texture coordinates.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {createRequire} from "node:module";

const [program, folder] = process.argv.slice(2);
const {generateTangents} = createRequire(path.resolve(import.meta.dirname, "x.js"))("mikktspace");
const kTolerance = 1e-5;  // between unit tangents: both average single-precision vectors, in another order

// Hills over a grid, u mirrored at x = 0, the texture turned and torn in a quarter, a strip without area in the texture
// and some triangles whose corners coincide.
function hills() {
  const side = 24, lines = [], coordinates = new Map();
  const uv = (u, v) => {
    const text = `vt ${u.toFixed(6)} ${v.toFixed(6)}`;
    if (!coordinates.has(text)) coordinates.set(text, coordinates.size + 1);
    return coordinates.get(text);
  };
  for (let j = 0; j <= side; ++j)
    for (let i = 0; i <= side; ++i) {
      const x = 2 * i / side - 1, z = 2 * j / side - 1;
      lines.push(`v ${x + 0.02 * Math.sin(17 * z + 3 * x)} ${0.2 * Math.sin(5 * x + z) * Math.cos(4 * z)} ${z}`);
    }
  const faces = [];
  for (let j = 0; j < side; ++j)
    for (let i = 0; i < side; ++i) {
      const corner = (di, dj) => {
        const x = 2 * (i + di) / side - 1, z = 2 * (j + dj) / side - 1;
        const row = 2 * (j + dj > side - 4 ? j + dj - 1 : j + dj) / side - 1;
        let at = [Math.abs(x), row * (1 + 0.3 * x)];
        if (i < side / 2 && j < side / 2) at = [0.8 * at[0] - 0.6 * at[1] + 3, 0.6 * at[0] + 0.8 * at[1]];
        return `${(j + dj) * (side + 1) + i + di + 1}/${uv(...at)}`;
      };
      faces.push(`f ${corner(0, 0)} ${corner(0, 1)} ${corner(1, 1)}`, `f ${corner(0, 0)} ${corner(1, 1)} ${corner(1, 0)}`);
      if (i % 7 === 3) faces.push(`f ${corner(0, 0)} ${corner(0, 0)} ${corner(1, 1)}`);
    }
  // a fan that a triangle without area in the texture joins
  const first = lines.length + 1;
  for (const [k, x, y] of [[0, 0, 0], [1, 1, 0], [2, 1, 1], [3, 0, 1], [4, -1, 0.5]]) {
    lines.push(`v ${x + 5} ${y} ${0.1 * k}`);
    uv(10 + [0, 1, 1, 1, 0.3][k], [0, 0, 1, 1, 1.5][k]);
  }
  for (const k of [1, 2, 3])
    faces.push(`f ${[0, k, k + 1].map((c) => `${first + c}/${uv(10 + [0, 1, 1, 1, 0.3][c], [0, 0, 1, 1, 1.5][c])}`).join(" ")}`);
  return [...lines, ...coordinates.keys(), ...faces].join("\n") + "\n";
}

const file = path.resolve(folder, "hills.obj");
fs.writeFileSync(file, hills());
const said = [];
const textureArea = (all, first) => {
  const [a, b, c] = [0, 1, 2].map((k) => all.slice(15 * (first + k) + 6, 15 * (first + k) + 8));
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
};
const unit = (v) => v.map((x) => x / Math.hypot(...v));
for (const mesh of ["sphere", "teapot", "torus-knot", file]) {
  const bytes = execFileSync(program, [mesh, "10000"], {maxBuffer: 1 << 28});
  const all = new Float32Array(new Uint8Array(bytes).buffer), corners = all.length / 15;
  const take = (first, count) =>
    Float32Array.from({length: count * corners}, (_, i) => all[15 * Math.floor(i / count) + first + i % count]);
  const expected = generateTangents(take(0, 3), take(3, 3), take(6, 2));
  let worst = 0, mirrored = 0, left = 0, surface = 0;
  for (let i = 0; i < corners; ++i) {
    const [theirs, side] = [[...expected.slice(4 * i, 4 * i + 3)], expected[4 * i + 3]];
    const from = (first) => Math.hypot(...unit(theirs).map((x, c) => x - all[15 * i + first + c]));
    surface = Math.max(surface, from(12));
    // MikkTSpace leaves x where a triangle without area in the texture lies between the two ways round
    if (theirs[0] === 1 && from(8) > kTolerance && textureArea(all, i - i % 3) === 0) {
      ++left;
      continue;
    }
    worst = Math.max(worst, from(8));
    assert.equal(all[15 * i + 11], side, `${mesh}: the side of corner ${i}`);
    mirrored += side < 0;
  }
  assert.ok(worst <= kTolerance, `${mesh}: a tangent is ${worst} off`);
  assert.ok(left <= 3, `${mesh}: ${left} corners that MikkTSpace leaves`);
  assert.equal(mirrored > 0, mesh === file);
  said.push(`${path.basename(mesh)} ${worst.toExponential(1)}` + (mesh === file ? "" : ` (the surface's own ${surface.toFixed(2)})`));
}
console.log(`web: tangents beside MikkTSpace's, largest difference: ${said.join(", ")}`);
