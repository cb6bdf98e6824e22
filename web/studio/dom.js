// Makes elements from data. Text only ever becomes text: nothing here parses markup.

export const find = (selector) => document.querySelector(selector);

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== undefined && child !== null && child !== false));
  return node;
}

// Example: make("button", {class: "quiet", onclick: f}, "Text", node, ...)
export const make = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);
export const svg = (tag, attributes = {}, ...children) =>
  fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

export const row = (cells, attributes = {}) => make("tr", attributes, ...cells.map((cell) => make("td", {}, cell)));
export const table = (caption, heads, rows) => make("table", {}, caption ? make("caption", {}, caption) : "",
  make("thead", {}, make("tr", {}, ...heads.map((name) => make("th", {scope: "col"}, name)))), make("tbody", {}, ...rows));

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Formats bytes, 2700 as "2.6 KB"; figures have few digits.
export function bytesText(bytes) {
  if (bytes < 1024) return `${bytes} B`;
  return bytes < 1024 * 1024 ? `${(bytes / 1024).toFixed(1)} KB` : `${(bytes / 1048576).toFixed(1)} MB`;
}
export function number(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  const size = Math.abs(x) < 1e-12 ? 0 : Math.abs(x);
  if (size === 0) return "0";
  const text = (size < 1e-3 || size >= 1e5) ? x.toExponential(2) : String(Number(x.toPrecision(digits)));
  return text.replace("-", "−");
}

// Formats a number briefly for a tick: 2e8 as "2·10⁸", 0.01 as "0.01".
export function tickText(x, digits) {
  const [mantissa, exponent] = x.toExponential(digits - 1).split("e").map(Number);
  if (x === 0 || (exponent >= -2 && exponent <= 3)) return number(x, digits);
  const power = `10${String(exponent).replace("-", "⁻").replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])}`;
  return mantissa === 1 ? power : `${String(mantissa).replace("-", "−")}·${power}`;
}

// Identifies an element by its function and its entry, so that its replacement is found.
const roleOf = (element) => [element.tagName, element.dataset.export ?? element.dataset.edit ?? element.getAttribute("aria-label") ?? (element.className || element.textContent),
                             element.closest("[data-of]")?.dataset.of].join();

// Replaces children. The replacement of a focused element gets the focus. Returns false if the focus was lost.
export function replaceKeepingFocus(place, ...children) {
  const held = place.contains(document.activeElement) ? roleOf(document.activeElement) : null;
  place.replaceChildren(...children);
  if (held === null) return true;
  const same = [...place.querySelectorAll("button, input, select")].find((element) => !element.disabled && roleOf(element) === held);
  same?.focus();
  return same !== undefined;
}

// Calls told(dx, dy) in pixels while a pointer drags the element. It subtracts places, since not every browser reports
// a finger's movement.
export function onDrag(element, told) {
  let last = null;
  element.addEventListener("pointerdown", (event) => {
    if (!event.isPrimary) return;
    element.setPointerCapture(event.pointerId);
    last = event;
  });
  element.addEventListener("pointermove", (event) => {
    if (event.pointerId !== last?.pointerId) return;
    told(event.clientX - last.clientX, event.clientY - last.clientY);
    last = event;
  });
  for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => (last = null));
}

export function saveFile(name, data, type = "application/octet-stream") {
  const url = URL.createObjectURL(data instanceof Blob ? data : new Blob([data], {type}));
  make("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

// Runs the latest of several requested tasks, one at a time. Requests between are dropped.
export function latest(task) {
  let running = false, again = null;
  return async function ask(...args) {
    if (running) {
      again = args;
      return;
    }
    running = true;
    try {
      await task(...args);
    } finally {
      running = false;
      if (again) {
        const next = again;
        again = null;
        ask(...next);
      }
    }
  };
}

// Shows a line above the page, which screen readers read too. An error stays until the next message or until it is
// closed.
export function say(text, kind = "note") {
  const line = find("#message");
  line.dataset.kind = kind;
  find("#message-text").textContent = text;
  line.hidden = !text;
  clearTimeout(say.timer);
  if (kind === "note" && text) say.timer = setTimeout(() => (line.hidden = true), 5000);
}
// The library's messages name the command line. These rules put them into the page's words. lineOf turns a thrown error
// into one line.
const kPageWords = [
  [/`burnish help formats` lists what is read/, "the list beside the files' box says what is read"],
  [/,? ?which `burnish (?:fit|convert)` makes of it/, ""],
  [/; `burnish fit` makes a model of it for that/, "; fit a model for that"],
  [/ \(`burnish info FILE` [^)]*\)/, ""],
  [/ Reflectance factors\? --brf divides them by pi\./, " These may be reflectance factors, which are pi times as large."],
  [/ ?\(--scale-to-tis scales them\)/, ""],
  [/--has-cosine/g, "“Times cos”"],
  [/--illuminant/g, "“Light”"],
  [/--back\b/g, "“Back side”"],
  [/--([a-z]+)(?:-([a-z]+))?(?:-([a-z]+))?/g, (_, ...words) => words.slice(0, 3).filter(Boolean).join(" ")],
  [/expected the command line, found WebAssembly/, "expected burnish's command line, found the page"],
];
export const pageWords = (text) => kPageWords.reduce((said, [from, to]) => said.replace(from, to), text);
export const lineOf = (error) => pageWords(String(error?.message ?? error).split("\n")[0]).slice(0, 400);
