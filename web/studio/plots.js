// Plots slices, the (theta_h, theta_d) picture, albedo and lobe of the shown materials. The left one is solid, the
// right one dashed.
import {linePath, plot, shareOfAxis} from "./chart.js";
import {css, find, latest, lineOf, make, number, say, svg, tickText} from "./dom.js";
import {drawLobe} from "./lobe.js";
import {segments} from "./segments.js";
import {onChange, state} from "./state.js";
import {clamp, degrees, direction, fromHalfDiff, radians, toRgb} from "./vectors.js";

const settings = {theta: radians(30), phiD: radians(90), log: true, channel: "rgb", coordinates: "polar"};
const kSteps = 177, kDecades = 4;
const sides = () => [state.shown, state.beside].filter(Boolean);

// Returns channels of rgb triples as lines: [{color, values}].
function channelsOf(rgb) {
  const take = (c) => Array.from({length: rgb.length / 3}, (_, i) => rgb[3 * i + c]);
  const names = ["--red", "--green", "--blue"];
  if (settings.channel === "mean")
    return [{color: css("--mean"), values: Array.from({length: rgb.length / 3}, (_, i) => (rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2]) / 3)}];
  const all = [0, 1, 2].map((c) => ({color: css(names[c]), values: take(c)}));
  const grey = settings.channel === "rgb" && rgb.every((x, i) => Number.isNaN(x) || Math.abs(x - rgb[i - (i % 3)]) <= 1e-6 * Math.abs(x));
  if (grey) return [{color: css("--mean"), values: all[0].values}];
  return settings.channel === "rgb" ? all : [all[Number(settings.channel)]];
}

// Returns rgb of each pair, NaN where it is unknown.
async function evaluate(entry, pairs) {
  const wi = new Float32Array(pairs.length * 3), wo = new Float32Array(pairs.length * 3);
  pairs.forEach(([a, b], k) => {
    wi.set(a, 3 * k);
    wo.set(b, 3 * k);
  });
  return toRgb(await entry.material.evaluate(wi, wo), entry.material.channels);
}

// Samples the plane of incidence. Negative theta_o lie on the light's side.
async function sliceLines() {
  const angles = Array.from({length: kSteps}, (_, k) => -88 + k), wi = direction(settings.theta, Math.PI);
  const pairs = angles.map((t) => [wi, direction(radians(Math.abs(t)), t < 0 ? Math.PI : 0)]);
  const lines = [];
  for (const entry of sides())
    for (const line of channelsOf(await evaluate(entry, pairs))) lines.push({...line, dashed: entry === state.beside, name: entry.name});
  return {angles, lines};
}

// Returns the range of a logarithmic axis: whole decades up to the largest value.
function range(lines) {
  const values = lines.flatMap((line) => line.values).filter(Number.isFinite), top = Math.max(...values, 1e-6);
  if (!settings.log) return [0, top * 1.05];
  const high = Math.ceil(Math.log10(top) - 1e-9), positive = values.filter((x) => x > 0);
  const low = clamp(Math.floor(Math.log10(Math.min(...positive, top))), high - kDecades, high - 2);
  return [10 ** low, 10 ** high];
}

function drawCartesian({angles, lines}) {
  const figure = plot({
    label: `f against theta_o at theta_i ${number(degrees(settings.theta), 3)} degrees`, x: [-90, 90], y: range(lines), log: settings.log,
    xTicks: [-90, -60, -30, 0, 30, 60, 90], xTick: (t) => `${t}°`.replace("-", "−"), xName: "θo", yName: "f, 1/sr",
    lines: lines.map((line) => ({...line, x: angles})), marks: [-degrees(settings.theta)],
  });
  onDrag(figure, ([x, , width]) => setTheta(180 * shareOfAxis(x / width) - 90));
  return figure;
}

function drawPolar({angles, lines}) {
  const width = 380, height = 212, middle = [190, 194], radius = 152, [low, high] = range(lines);
  const grow = (v) => (settings.log ? clamp(Math.log(Math.max(v, low) / low) / Math.log(high / low), 0, 1) : clamp(v / high, 0, 1));
  const at = (degree, share) => [middle[0] + radius * share * Math.sin(radians(degree)), middle[1] - radius * share * Math.cos(radians(degree))];
  const place = (p) => p.map((x) => x.toFixed(2)).join(",");
  const grid = css("--grid"), soft = css("--soft");
  const figure = svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `Polar slice at theta_i ${number(degrees(settings.theta), 3)} degrees`});
  const rings = settings.log ? Array.from({length: Math.round(Math.log10(high / low))}, (_, k) => low * 10 ** (k + 1)) : [high / 2, high / 1.05];
  for (const r of rings.map((value) => radius * grow(value)))
    figure.append(svg("path", {d: `M${middle[0] - r},${middle[1]}a${r},${r} 0 0 1 ${2 * r},0`, fill: "none", stroke: grid}));
  for (const degree of [-90, -60, -30, 0, 30, 60, 90]) {
    const [x, y] = at(degree, 1.06);
    figure.append(svg("path", {d: `M${place(middle)}L${place(at(degree, 1))}`, stroke: grid}),
                  degree === 0 ? "" : svg("text", {x, y: y + 3, fill: soft, "text-anchor": degree < 0 ? "end" : "start"}, `${Math.abs(degree)}°`));
  }
  for (const line of lines) figure.append(linePath(line.values.map((v, k) => at(angles[k], grow(v))), line));
  // Texts lie above lines and are cut out of them.
  for (const value of rings)
    figure.append(svg("text", {x: middle[0] + 3, y: middle[1] - radius * grow(value) - 3, fill: soft, stroke: css("--panel"), "stroke-width": 4,
                               "stroke-linejoin": "round", "paint-order": "stroke", "data-ring": value}, tickText(value, 2)));
  const tip = at(-degrees(settings.theta), 1), accent = css("--accent");
  figure.append(svg("path", {d: `M${place(tip)}L${place(middle)}`, stroke: accent, "stroke-width": 1.6}),
                svg("circle", {cx: tip[0], cy: tip[1], r: 6, fill: accent}),
                svg("circle", {cx: tip[0], cy: tip[1], r: 22, fill: "transparent", cursor: "move", class: "handle"}));  // wide enough for a finger
  onDrag(figure, ([x, y, w, h]) => {
    const dx = (x / w) * width - middle[0], dy = middle[1] - (y / h) * height;
    setTheta(degrees(Math.abs(Math.atan2(dx, Math.max(dy, 1e-3)))));
  });
  return figure;
}

function onDrag(figure, told) {
  figure.addEventListener("pointerdown", (event) => {
    find("#slices").setPointerCapture(event.pointerId);
    dragging = told;
    move(event);
  });
  // A finger on the handle moves the handle and not the page.
  figure.addEventListener("touchstart", (event) => event.target.classList.contains("handle") && event.preventDefault(), {passive: false});
}
let dragging = null;
function move(event) {
  if (!dragging) return;
  const box = find("#slices").firstElementChild.getBoundingClientRect();
  dragging([event.clientX - box.left, event.clientY - box.top, box.width, box.height]);
}

function setTheta(degree) {
  const theta = clamp(Math.abs(degree), 0, 85);
  settings.theta = radians(theta);
  find("#theta").value = theta;
  find("#theta-value").textContent = `${Math.round(theta)}°`;
  redrawSlices();
}

const guarded = (task) => latest(async () => {
  const before = sides();
  try {
    await task();
  } catch (error) {
    // Errors of a material that was closed meanwhile are not shown.
    if (before.every((entry) => state.entries.includes(entry))) say(lineOf(error), "error");
  }
});

const emptyChart = (height) => svg("svg", {viewBox: `0 0 380 ${height}`, role: "img", "aria-label": "Nothing to plot yet"},
  svg("text", {x: 190, y: height / 2, "text-anchor": "middle"}, "nothing open"));

const redrawSlices = guarded(async () => {
  const place = find("#slices");
  if (!state.shown) {
    place.replaceChildren(emptyChart(212));
    find("#lobe").replaceChildren(emptyChart(212));
    return;
  }
  const slice = await sliceLines();
  place.replaceChildren(settings.coordinates === "polar" ? drawPolar(slice) : drawCartesian(slice));
  await drawLobe(find("#lobe"), state.beside ?? state.shown, settings, evaluate);
});

// Draws the usual picture of an isotropic BRDF: theta_h to the right by its square root, theta_d upwards.
async function halfDiffImage(entry, scaleOf) {
  const size = 96, pairs = [], places = [];
  for (let y = 0; y < size; ++y)
    for (let x = 0; x < size; ++x) {
      const thetaH = (Math.PI / 2) * ((x + 0.5) / size) ** 2, thetaD = (Math.PI / 2) * ((size - 0.5 - y) / size);
      const [wi, wo] = fromHalfDiff(thetaH, 0, thetaD, settings.phiD);
      if (wi[2] <= 0 || wo[2] <= 0) continue;
      pairs.push([wi, wo]);
      places.push(y * size + x);
    }
  const rgb = await evaluate(entry, pairs), scale = scaleOf ?? logScale(rgb);
  const image = new ImageData(size, size);
  places.forEach((place, k) => {
    if (Number.isNaN(rgb[3 * k])) return;
    for (let c = 0; c < 3; ++c) image.data[4 * place + c] = 255 * scale(rgb[3 * k + c]);
    image.data[4 * place + 3] = 255;
  });
  const canvas = make("canvas", {width: size, height: size, role: "img", "aria-label": `${entry.name} over theta_h and theta_d`});
  canvas.getContext("2d").putImageData(image, 0, 0);
  return {figure: make("figure", {}, canvas, make("figcaption", {}, entry.name)), scale};
}
// Maps logarithms to grey levels, from the 2nd percentile to the largest value.
function logScale(rgb) {
  const positive = [...rgb].filter((x) => x > 0).sort((a, b) => a - b);
  const low = Math.log(Math.max(positive[Math.floor(0.02 * positive.length)] ?? 1e-3, 1e-5)) - 0.5, high = Math.log(positive.at(-1) ?? 1);
  return (x) => (x > 0 ? clamp((Math.log(x) - low) / (high - low), 0, 1) : 0);
}

const redrawImages = guarded(async () => {
  const place = find("#half-diff");
  if (!state.shown) {
    place.replaceChildren(emptyChart(212));
    return;
  }
  const first = await halfDiffImage(state.shown), figures = [first.figure];
  if (state.beside) figures.push((await halfDiffImage(state.beside, first.scale)).figure);
  place.replaceChildren(make("div", {class: "images"}, ...figures),
    make("p", {class: "hint"}, "Right: the root of θh. Up: θd. Brightness: the logarithm of f."));
});

const redrawAlbedo = guarded(async () => {
  const place = find("#albedo");
  if (!state.shown) {
    place.replaceChildren(emptyChart(212));
    return;
  }
  const angles = [0, 10, 20, 30, 40, 50, 60, 65, 70, 75, 80, 85], lines = [];
  for (const entry of sides()) {
    const values = await entry.material.albedo(angles.map(radians));
    const rgb = toRgb(Float32Array.from(values.flat?.() ?? values), entry.material.channels);
    for (const line of channelsOf(rgb)) lines.push({...line, x: angles, dashed: entry === state.beside});
  }
  const top = Math.max(1, ...lines.flatMap((line) => line.values).filter(Number.isFinite));
  place.replaceChildren(plot({
    label: "Albedo against the angle of incidence", x: [0, 90], y: [0, top > 1 ? top * 1.05 : 1], xTicks: [0, 15, 30, 45, 60, 75, 90],
    xTick: (t) => `${t}°`, xName: "θi", yName: "albedo", lines,
  }));
});

export function redraw() {
  redrawSlices();
  redrawImages();
  redrawAlbedo();
}

export function start() {
  segments(find("#coordinates"), (coordinates) => {
    settings.coordinates = coordinates;
    redrawSlices();
  });
  find("#log").addEventListener("change", (event) => {
    settings.log = event.target.checked;
    redrawSlices();
  });
  find("#channel").addEventListener("change", (event) => {
    settings.channel = event.target.value;
    redrawSlices();
    redrawAlbedo();
  });
  find("#theta").addEventListener("input", (event) => setTheta(Number(event.target.value)));
  find("#phi").addEventListener("input", (event) => {
    settings.phiD = radians(Number(event.target.value));
    find("#phi-value").textContent = `${event.target.value}°`;
    redrawImages();
  });
  find("#slices").addEventListener("pointermove", move);
  for (const end of ["pointerup", "pointercancel"]) find("#slices").addEventListener(end, () => (dragging = null));
  onChange((what) => {
    if (what !== "shown" && !what.renewed) return;
    // A grey material has one channel.
    find("#channel").disabled = sides().length > 0 && sides().every(({material}) => material.channels === 1);
    redraw();
  });
  redraw();
}
