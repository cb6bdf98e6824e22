// The view's controls: shape, lights, exposure, divider.
import {css, find, lineOf, make, onDrag, say} from "./dom.js";
import {isPicture, readExr} from "./exr.js";
import {readHdr} from "./hdr.js";
import {segments} from "./segments.js";
import {kLights} from "./shading.js";
import {changed, isSurface, onChange, state} from "./state.js";
import {clamp} from "./vectors.js";
import {View} from "./view.js";

let touched = 0;  // the light that was moved last
let view = null, exposedFor = null, exposes = true;  // until the slider is moved

// A light's handle stands at its direction seen from the front, at this share of the half frame.
const kRing = 0.94;

function rgbOfCss(name) {
  const hex = css(name);
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}

function drawHandles() {
  const {lights} = view.settings, place = find("#handles");
  while (place.children.length > lights.length) place.lastChild.remove();
  while (place.children.length < lights.length) place.append(handle(place.children.length));
  const {clientWidth: width, clientHeight: height} = find("#scene"), half = (kRing * Math.min(width, height)) / 2;
  find("#add-light").disabled = lights.length >= kLights;
  find("#remove-light").disabled = lights.length === 0;
  lights.forEach(({place: [x, y]}, k) => {
    place.children[k].style.transform = `translate(${width / 2 + half * x}px, ${height / 2 - half * y}px)`;
  });
}

function moveLight(k, x, y) {
  const r = Math.max(Math.hypot(x, y), 1), lights = [...view.settings.lights];
  touched = k;
  lights[k] = {...lights[k], place: [x / r, y / r, Math.sqrt(Math.max(1 - (x * x + y * y) / (r * r), 0))]};
  view.set({lights});
  drawHandles();
}

function removeLight(k) {
  const handles = find("#handles"), focused = handles.contains(document.activeElement);
  view.set({lights: view.settings.lights.filter((_, other) => other !== k)});
  touched = view.settings.lights.length - 1;
  drawHandles();
  if (focused) (handles.children[Math.min(k, touched)] ?? find("#add-light")).focus();
}

function handle(k) {
  const button = make("button", {type: "button", "aria-label": `Light ${k + 1}: arrow keys move it, Delete removes it`, title: "Drag the light; double click removes it"});
  button.addEventListener("pointerdown", (event) => {
    touched = k;
    button.setPointerCapture(event.pointerId);
  });
  button.addEventListener("pointermove", (event) => {
    if (!button.hasPointerCapture(event.pointerId)) return;
    const box = find("#scene").getBoundingClientRect(), half = (kRing * Math.min(box.width, box.height)) / 2;
    moveLight(k, (event.clientX - box.left - box.width / 2) / half, (box.top + box.height / 2 - event.clientY) / half);
  });
  button.addEventListener("dblclick", () => removeLight(k));
  button.addEventListener("keydown", (event) => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (event.key === "Delete") removeLight(k);
    if (!step) return;
    event.preventDefault();
    const [x, y] = view.settings.lights[k].place;
    moveLight(k, x + 0.04 * step[0], y + 0.04 * step[1]);
  });
  return button;
}

function turn(dx, dy) {
  view.set({yaw: view.settings.yaw + dx, pitch: clamp(view.settings.pitch + dy, -1.5, 1.5)});
}

function connectCanvas() {
  const canvas = find("#view");
  onDrag(canvas, (dx, dy) => turn(dx / 150, dy / 150));
  canvas.addEventListener("keydown", (event) => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (!step) return;
    event.preventDefault();
    turn(0.1 * step[0], 0.1 * step[1]);
  });
  canvas.addEventListener("webglcontextlost", () => say("The graphics card dropped the picture; load the page again to see it.", "error"));
}

function connectDivider() {
  const divider = find("#divider"), scene = find("#scene");
  const move = (share) => {
    const at = clamp(share, 0.02, 0.98);
    divider.style.left = `${100 * at}%`;
    divider.setAttribute("aria-valuenow", Math.round(100 * at));
    view.set({divider: at});
  };
  divider.addEventListener("pointerdown", (event) => divider.setPointerCapture(event.pointerId));
  divider.addEventListener("pointermove", (event) => {
    const box = scene.getBoundingClientRect();
    if (divider.hasPointerCapture(event.pointerId)) move((event.clientX - box.left) / box.width);
  });
  divider.addEventListener("keydown", (event) => {
    const step = {ArrowLeft: -0.02, ArrowRight: 0.02}[event.key];
    if (!step) return;
    event.preventDefault();
    move(view.settings.divider + step);
  });
}

function setExposure(stops) {
  find("#exposure").value = stops;
  find("#exposure-value").textContent = Number(stops).toFixed(1).replace("-", "−");
  view.set({exposure: Number(stops)});
}
function expose() {
  if (!exposes) return;
  const stops = view.autoExposure();
  if (stops !== null) setExposure(clamp(Math.round(20 * stops) / 20, -10, 10));
}

function drawThumbnail(entry) {
  const size = 80, canvas = (entry.picture ??= make("canvas", {width: size, height: size, "aria-hidden": "true"}));
  view.thumbnail(entry, size, (image) => canvas.getContext("2d").putImageData(image, 0, 0));
}

const kShown = {left: 0, right: 1, split: 2, error: 3};
let setShown = () => {}, setShape = () => {};

function drawNames() {
  find("#left-name").textContent = state.shown?.name ?? "";
  find("#right-name").textContent = state.beside?.name ?? "";
}

// An isotropic material has no preferred direction along the surface, so no tangents are shown.
function showTangents() {
  const box = find("#tangents");
  box.disabled = [state.shown, state.beside].every((entry) => !entry || (entry.material.isotropic && !isSurface(entry)));
  view?.set({tangents: box.checked && !box.disabled});
}

function show() {
  const both = state.beside !== null;
  find("#welcome").hidden = state.shown !== null;
  drawNames();
  for (const button of find("#shown").children) button.disabled = !both && button.dataset.value !== "left";
  if (!both) choose("left");
  else if (view?.settings.shown === 0) choose("split");
  if (isSurface(state.shown) && view?.settings.shape !== "plane") {
    setShape("plane");
    view?.set({shape: "plane"});
  }
  showTangents();
  view?.show(state.shown, state.beside);
  if (state.shown?.seen && exposedFor !== state.shown.id) {
    exposedFor = state.shown.id;
    expose();
  }
}
function choose(name) {
  setShown(name);
  const shown = kShown[name];
  find("#divider").hidden = name !== "split";
  find("#error-scale").hidden = name !== "error";
  find("#left-name").hidden = name === "right";
  find("#right-name").hidden = name === "left";
  view?.set({shown});
}

// Takes environment lighting from a dropped picture. Returns false for a file that is no readable picture. Throws the
// picture's error.
export async function openPicture(file) {
  const bytes = new Uint8Array(await file.arrayBuffer()), hdr = /\.hdr$/i.test(file.name);
  if (!hdr && !isPicture(bytes)) return false;
  const {width, height, data} = hdr ? readHdr(bytes, view?.largestPicture) : await readExr(bytes, view?.largestPicture);
  view?.setPicture(width, height, data);
  const around = find("#around");
  const choice = around.querySelector("[value=picture]");
  [choice.disabled, choice.textContent] = [false, file.name];
  around.value = "picture";
  view?.set({around: "picture"});
  if (view) expose();
  say(`${file.name} lights the object`);
  return true;
}

export function themeChanged() {
  if (!view) return;
  view.background = rgbOfCss("--scene");
  view.ask();
}

export const picture = (signal) => view?.png(signal);

function connect() {
  setShape = segments(find("#shape"), (shape) => {
    view.set({shape});
    expose();
  });
  setShown = segments(find("#shown"), choose);
  const around = find("#around");
  around.addEventListener("change", () => {
    view.set({around: around.value});
    expose();
  });
  find("#exposure").addEventListener("input", (event) => {
    exposes = false;
    setExposure(event.target.value);
  });
  find("#expose").addEventListener("click", () => {
    exposes = true;
    expose();
  });
  find("#curve").addEventListener("change", (event) => view.set({curve: Number(event.target.value)}));
  find("#error-factor").addEventListener("change", ({target: {value}}) => {
    find("#error-most").textContent = `${100 / value} %`;
    view.set({factor: Number(value)});
  });
  find("#tangents").addEventListener("change", showTangents);
  find("#add-light").addEventListener("click", () => {
    const {lights} = view.settings;
    view.set({lights: [...lights, {place: [[0.6, 0.3, 0.74], [-0.6, -0.4, 0.69], [0.1, -0.7, 0.71], [-0.5, 0.55, 0.67]][lights.length % 4], color: [10, 10, 10]}]});
    touched = view.settings.lights.length - 1;
    drawHandles();
  });
  find("#remove-light").addEventListener("click", () => removeLight(touched));
  connectCanvas();
  connectDivider();
  new ResizeObserver(drawHandles).observe(find("#scene"));
}

export function start() {
  try {
    view = new View(find("#view"));
  } catch (error) {
    find("#welcome").textContent = error.message;
    view = null;
    return;
  }
  view.onframe = () => {
    const rate = view.settled ? "" : `${Math.min(Math.round(1000 / (view.pace ?? 1000)), 240)} frames/s`;
    if (find("#pace").textContent !== rate) find("#pace").textContent = rate;
    document.documentElement.dataset.view = state.shown && view.formOf(state.shown) ? (view.settled ? "settled" : "drawing") : "empty";
  };
  view.onready = (entry, first) => {
    if (entry === state.shown && first && exposedFor !== entry.id) {
      exposedFor = entry.id;
      expose();
    }
    drawThumbnail(entry);
  };
  view.onseen = (entry) => (entry.seen = true);
  view.onexact = (entry, share) => {
    entry.computed = share;
    changed("judged");
  };
  view.onjudged = (entry, drawn) => {
    entry.drawn = drawn;
    changed("judged");
  };
  view.onerror = (error) => say(lineOf(error), "error");
  connect();
  themeChanged();
  drawHandles();
  onChange((what) => {
    if (what === "shown") show();
    if (what.closed) view.forget(what.closed);
    if (what.renewed) {
      view.refresh(what.renewed);
      showTangents();
      drawNames();
    }
  });
}
