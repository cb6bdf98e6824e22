// Line charts as SVG. Every colour is an attribute, so a saved chart looks the same anywhere.
import {css, number, svg, tickText} from "./dom.js";

const kWidth = 380, kHeight = 212, kLeft = 46, kRight = 12, kTop = 8, kBottom = 34;

function niceTicks([low, high]) {
  const raw = (high - low) / 5, unit = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find((k) => k * unit >= raw) * unit;
  return Array.from({length: Math.floor(high / step + 1e-9) - Math.ceil(low / step - 1e-9) + 1}, (_, k) => (Math.ceil(low / step - 1e-9) + k) * step);
}
const decades = ([low, high]) =>
  Array.from({length: Math.round(Math.log10(high / low)) + 1}, (_, k) => 10 ** (Math.round(Math.log10(low)) + k));

// Draws {label, x: [low, high], y: [low, high], log (of y), logX, xTicks, xTick(value), xName, yName,
// lines: [{x, values, color, dashed, dots}], marks: places on x}.
export function plot(given) {
  const right = kWidth - kRight, bottom = kHeight - kBottom, toX = axis(given.x, kLeft, right, given.logX), toY = axis(given.y, bottom, kTop, given.log);
  const soft = css("--soft"), grid = css("--grid"), ink = css("--accent");
  const figure = svg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": given.label});
  for (const value of given.log ? decades(given.y) : niceTicks(given.y))
    figure.append(svg("path", {d: `M${kLeft},${toY(value)}H${right}`, stroke: grid}),
                  svg("text", {x: kLeft - 6, y: toY(value) + 4, "text-anchor": "end", fill: soft}, tickText(value, 3)));
  for (const value of given.xTicks ?? niceTicks(given.x))
    figure.append(svg("path", {d: `M${toX(value)},${kTop}V${bottom}`, stroke: grid}),
                  svg("text", {x: toX(value), y: bottom + 15, "text-anchor": "middle", fill: soft}, given.xTick?.(value) ?? number(value, 3)));
  figure.append(svg("text", {x: right, y: kHeight - 4, "text-anchor": "end", fill: soft}, given.xName),
                svg("text", {x: kLeft, y: kHeight - 4, "text-anchor": "start", fill: soft}, given.yName));
  for (const mark of given.marks ?? [])
    figure.append(svg("path", {d: `M${toX(mark)},${kTop}V${bottom}`, stroke: ink, "stroke-width": 1.6}),
                  svg("circle", {cx: toX(mark), cy: bottom, r: 6, fill: ink, cursor: "ew-resize"}));
  for (const line of given.lines) {
    const points = line.values.map((v, k) => [toX(line.x[k]), toY(v)]);
    figure.append(linePath(points, line));
    if (line.dots) for (const [cx, cy] of points.filter(isKnown)) figure.append(svg("circle", {cx, cy, r: 3, fill: line.color}));
  }
  return figure;
}
const isKnown = (point) => point.every(Number.isFinite);
// Draws a line through points, with gaps at unknown numbers. A point alone between gaps is a dot.
export function linePath(points, {color, dashed}) {
  const pieces = [[]];
  for (const point of points) {
    if (!isKnown(point)) pieces.push([]);
    else pieces.at(-1).push(point.map((x) => x.toFixed(2)).join(","));
  }
  const d = pieces.filter((piece) => piece.length).map((piece) => `M${piece.join("L")}${piece.length === 1 ? "h0" : ""}`).join("");
  return svg("path", {d, fill: "none", stroke: color, "stroke-width": 1.8, "stroke-dasharray": dashed ? "5 4" : null, "stroke-linejoin": "round",
                      "stroke-linecap": dashed ? null : "round"});
}
// Returns the place on x, in [0, 1] of the axis, at this share of a chart's width.
export const shareOfAxis = (share) => (share * kWidth - kLeft) / (kWidth - kLeft - kRight);

// Maps values to pixels. Values outside the range stand at the edge.
function axis([low, high], from, to, log) {
  const at = log ? (v) => Math.log(Math.max(v, low) / low) / Math.log(high / low) : (v) => (v - low) / (high - low);
  return (v) => from + (to - from) * Math.min(Math.max(at(v), 0), 1);
}
