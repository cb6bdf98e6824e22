// Meshes of the view: {vertices: position, normal and tangent, nine floats each; indices}, y up, in the unit sphere.
import {parts, turned} from "./teapot.js";
import {add, cross, normalize, scale} from "./vectors.js";

// Appends a grid over [0, 1]^2 to the mesh. at(u, v) gives [position, normal, tangent].
function appendGrid(mesh, columns, rows, at) {
  const first = mesh.vertices.length / 9;
  for (let i = 0; i <= columns; ++i)
    for (let j = 0; j <= rows; ++j) for (const part of at(i / columns, j / rows)) mesh.vertices.push(...part);
  for (let i = 0; i < columns; ++i)
    for (let j = 0; j < rows; ++j) {
      const a = first + i * (rows + 1) + j, b = a + rows + 1;
      mesh.indices.push(a, b, a + 1, a + 1, b, b + 1);
    }
  return mesh;
}
const empty = () => ({vertices: [], indices: []});

export const sphere = () =>
  appendGrid(empty(), 128, 96, (u, v) => {
    const phi = 2 * Math.PI * u, theta = 1e-4 + (Math.PI - 2e-4) * v;
    const n = [Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi)];
    return [scale(n, 0.92), n, [Math.cos(phi), 0, -Math.sin(phi)]];
  });

export const plane = () =>
  appendGrid(empty(), 16, 16, (u, v) => [[1.7 * u - 0.85, 1.7 * v - 0.85, 0], [0, 0, 1], [1, 0, 0]]);

export function knot() {
  const curve = (u) => {
    const a = 4 * Math.PI * u, b = 6 * Math.PI * u, r = 0.29 * (2 + Math.cos(b));
    return [r * Math.cos(a), r * Math.sin(a), 0.29 * Math.sin(b)];
  };
  return appendGrid(empty(), 640, 48, (u, v) => {
    const p = curve(u), along = normalize(add(curve(u + 1e-4), p, -1));
    const side = normalize(cross(along, p)), up = cross(side, along), phi = 2 * Math.PI * v;
    const normal = add(scale(up, Math.cos(phi)), side, Math.sin(phi));
    return [add(p, normal, 0.15), normal, along];
  });
}

// Returns the point and derivatives of a bicubic Bezier patch.
function patchAt(patch, u, v) {
  const basis = (x) => [(1 - x) ** 3, 3 * x * (1 - x) ** 2, 3 * x * x * (1 - x), x ** 3];
  const slope = (x) => [-3 * (1 - x) ** 2, 3 * (1 - x) * (1 - 3 * x), 3 * x * (2 - 3 * x), 3 * x * x];
  const sum = (a, b) => {
    let s = [0, 0, 0];
    for (let j = 0; j < 4; ++j) for (let i = 0; i < 4; ++i) s = add(s, patch[4 * j + i], a[i] * b[j]);
    return s;
  };
  return {point: sum(basis(u), basis(v)), du: sum(slope(u), basis(v)), dv: sum(basis(u), slope(v))};
}
function patches() {
  const all = [];
  parts.forEach((numbers, part) => {
    for (let image = 0; image < (turned[part] ? 4 : 2); ++image) {
      const patch = Array.from({length: 16}, (_, k) => {
        // One reflection turns the surface inside out, so u runs the other way.
        const from = image === 1 || image === 2 ? (k & ~3) + 3 - (k & 3) : k;
        const [x, y, z] = numbers.slice(3 * from, 3 * from + 3);
        return [image >= 2 ? -x : x, image % 2 ? -y : y, z];
      });
      all.push(patch);
    }
  });
  return all;
}
export function teapot() {
  const mesh = empty(), upright = ([x, y, z]) => [x, z, -y];
  for (const patch of patches())
    appendGrid(mesh, 14, 14, (u, v) => {
      const {point} = patchAt(patch, u, v);
      // At the knob's top and the bottom's middle a row of control points coincides. A step inwards avoids the missing
      // derivative.
      const inner = patchAt(patch, u, Math.min(Math.max(v, 1e-3), 1 - 1e-3));
      const normal = normalize(cross(inner.du, inner.dv));
      const tangent = normalize([-normal[1], normal[0], 1e-9]);
      const along = Math.hypot(normal[0], normal[1]) > 1e-4 ? [tangent[0], tangent[1], 0] : [1, 0, 0];
      return [scale(upright(add(point, [0.24, 0, 1.575], -1)), 1 / 3.3), upright(normal), upright(along)];
    });
  return mesh;
}
