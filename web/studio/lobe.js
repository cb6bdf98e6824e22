// Draws the lobe in three dimensions: a surface at distance f from the middle, or its logarithm, at one theta_i.
import {css, make, number, onDrag} from "./dom.js";
import {add, cross, degrees, direction, dot, normalize, radians, scale} from "./vectors.js";

const kThetas = 31, kPhis = 60, kDecades = 3.5, kSize = [760, 424];
const turned = {yaw: 0.6, pitch: 0.45};
let redraw = () => {};

// Returns pairs over the hemisphere of wo, theta fastest. The mirror direction is at phi 0.
function hemisphere(theta) {
  const wi = direction(theta, Math.PI), pairs = [];
  for (let j = 0; j < kPhis; ++j)
    for (let i = 0; i < kThetas; ++i) pairs.push([wi, direction(radians((89 * i) / (kThetas - 1)), (2 * Math.PI * j) / kPhis)]);
  return pairs;
}

export async function drawLobe(place, entry, {theta, log}, evaluate) {
  const pairs = hemisphere(theta), rgb = await evaluate(entry, pairs), largest = rgb.reduce((most, x) => (x > most ? x : most), 1e-9);
  const low = largest * 10 ** -kDecades;
  const points = pairs.map(([, wo], k) => {
    const value = Math.max((rgb[3 * k] + rgb[3 * k + 1] + rgb[3 * k + 2]) / 3, 0);
    const size = log ? Math.max(Math.log10(Math.max(value, low) / low) / kDecades, 0) : value / largest;
    const top = Math.max(rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2], 1e-12);
    return {at: scale(wo, size), color: [0, 1, 2].map((c) => Math.max(rgb[3 * k + c], 0) / top)};
  });
  const canvas = place.querySelector("canvas") ?? newCanvas(place);
  canvas.setAttribute("aria-label", `Lobe of ${entry.name} at theta_i ${number(degrees(theta), 3)} degrees. Drag or use the arrow keys to turn it.`);
  redraw = () => paint(canvas, points, theta);
  redraw();
}

function newCanvas(place) {
  const canvas = make("canvas", {width: kSize[0], height: kSize[1], role: "img", tabindex: 0});
  const turn = (dx, dy) => {
    turned.yaw += dx;
    turned.pitch = Math.min(Math.max(turned.pitch + dy, -0.2), 1.5);
    redraw();
  };
  onDrag(canvas, (dx, dy) => turn(dx / 120, dy / 120));
  canvas.addEventListener("keydown", (event) => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (!step) return;
    event.preventDefault();
    turn(0.1 * step[0], 0.1 * step[1]);
  });
  place.replaceChildren(canvas);
  return canvas;
}

// Draws quadrangles from the farthest to the nearest, on a ground of rings.
function paint(canvas, points, theta) {
  const pen = canvas.getContext("2d"), [width, height] = kSize, size = 300;
  const c = Math.cos(turned.yaw), s = Math.sin(turned.yaw), e = Math.sin(turned.pitch), d = Math.cos(turned.pitch);
  const see = ([x, y, z]) => {
    const u = c * x - s * y, v = s * x + c * y;
    return [width / 2 + size * u, height * 0.69 - size * (z * d + v * e), v * d - z * e];
  };
  pen.clearRect(0, 0, width, height);
  pen.lineWidth = 1.5;
  pen.strokeStyle = css("--grid");
  for (const r of [0.5, 1]) {
    pen.beginPath();
    for (let k = 0; k <= 72; ++k) pen.lineTo(...see(scale(direction(Math.PI / 2, (k * Math.PI) / 36), r)).slice(0, 2));
    pen.stroke();
  }
  const faces = [];
  for (let j = 0; j < kPhis; ++j)
    for (let i = 0; i + 1 < kThetas; ++i) {
      const next = ((j + 1) % kPhis) * kThetas + i, here = j * kThetas + i;
      const corners = [here, here + 1, next + 1, next].map((k) => points[k]);
      if (corners.some(({at}) => at.some(Number.isNaN))) continue;
      const normal = cross(add(corners[2].at, corners[0].at, -1), add(corners[3].at, corners[1].at, -1));
      const seen = corners.map(({at}) => see(at));
      faces.push({seen, depth: seen.reduce((sum, p) => sum + p[2], 0), normal, color: corners[0].color});
    }
  faces.sort((a, b) => b.depth - a.depth);
  const light = normalize([-0.4, -0.5, 0.8]);
  for (const {seen, normal, color} of faces) {
    const length = Math.hypot(...normal) || 1, shade = 0.45 + 0.55 * Math.abs(dot(normal, light) / length);
    pen.fillStyle = pen.strokeStyle = `rgb(${color.map((x) => Math.round(255 * shade * (0.25 + 0.75 * x))).join(",")})`;
    pen.lineWidth = 0.7;
    pen.beginPath();
    for (const p of seen) pen.lineTo(p[0], p[1]);
    pen.closePath();
    pen.fill();
    pen.stroke();
  }
  pen.strokeStyle = css("--accent");
  pen.lineWidth = 3;
  pen.beginPath();
  pen.moveTo(...see([0, 0, 0]).slice(0, 2));
  pen.lineTo(...see(direction(theta, Math.PI)).slice(0, 2));
  pen.stroke();
}
