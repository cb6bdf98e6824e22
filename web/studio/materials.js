// Opening and listing: files dropped, chosen or pasted, analytic models, the sample, links.
import {bytesText, find, lineOf, make, say} from "./dom.js";
import {open} from "./library.js";
import {add, changed, entryOf, onChange, remove, show, showBeside, state} from "./state.js";

let stop = null;

// Opens one thing, adds it to the list and shows it; nothing where it was stopped or is no BRDF, and then says why.
export async function openOne(data, name, more = {}) {
  stop?.abort();
  const mine = (stop = new AbortController());
  const bar = find("#opening-bar");
  bar.removeAttribute("value");
  find("#opening-text").textContent = name;
  find("#opening").hidden = false;
  try {
    const onProgress = (fraction) => (bar.value = fraction);
    const material = await open(data, {name, signal: mine.signal, onProgress});
    const entry = add({name, material, info: null, ...more});
    changed();
    show(entry);
    // what it is in full takes longer than showing it
    entry.info = await material.info({signal: mine.signal});
    changed();
    return entry;
  } catch (error) {
    if (error?.name !== "AbortError") say(lineOf(error).includes(name) ? lineOf(error) : `${name}: ${lineOf(error)}`, "error");
    return null;
  } finally {
    if (stop === mine) {
      stop = null;
      find("#opening").hidden = true;
    }
  }
}

async function openFiles(files, onPicture) {
  for (const file of files) {
    if (/\.(hdr|exr)$/i.test(file.name) && (await onPicture(file))) continue;
    if (!(await openOne(file, file.name)) && files.length === 1) return;
  }
}

function subtitle({info, parent}) {
  if (!info) return "…";
  if (parent !== null) return `${bytesText(info.bytes)} model`;
  return info.bytes ? `${info.format}, ${bytesText(info.bytes)}` : info.format;
}

function row(entry) {
  const picture = (entry.picture ??= make("canvas", {width: 80, height: 80, "aria-hidden": "true"}));
  const shown = entry === state.shown || entry === state.beside;
  return make("li", {class: entry.parent !== null ? "model" : "", "data-shown": shown},
    make("button", {class: "pick", type: "button", title: entry.name, "aria-pressed": String(shown), onclick: () => show(entry)},
         picture, make("span", {}, make("b", {}, entry.name), make("small", {}, subtitle(entry)))),
    make("button", {class: "close", type: "button", "aria-label": `Close ${entry.name}`, title: "Close", onclick: () => remove(entry)}, "×"));
}

function draw() {
  find("#list").replaceChildren(...state.entries.map(row));
  const beside = find("#beside");
  beside.replaceChildren(make("option", {value: ""}, "nothing"),
    ...state.entries.filter((e) => e !== state.shown).map((e) => make("option", {value: e.id}, e.name)));
  beside.value = state.beside?.id ?? "";
  beside.disabled = state.entries.length < 2;
}

export function start(onPicture) {
  const files = find("#files"), veil = find("#drop-veil");
  find("#choose").addEventListener("click", () => files.click());
  files.addEventListener("change", async () => {
    const chosen = [...files.files];
    files.value = "";
    await openFiles(chosen, onPicture);
  });
  find("#opening-stop").addEventListener("click", () => stop?.abort());
  find("#beside").addEventListener("change", (event) => showBeside(entryOf(Number(event.target.value))));

  // the whole page is where things are dropped
  let inside = 0;
  const carries = (event) => event.dataTransfer?.types.includes("Files");
  window.addEventListener("dragenter", (event) => {
    if (!carries(event)) return;
    ++inside;
    veil.hidden = false;
  });
  window.addEventListener("dragleave", (event) => {
    if (carries(event) && --inside <= 0) veil.hidden = true;
  });
  window.addEventListener("dragover", (event) => event.preventDefault());
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    inside = 0;
    veil.hidden = true;
    openFiles([...event.dataTransfer.files], onPicture);
  });
  window.addEventListener("paste", (event) => {
    if (event.clipboardData.files.length) openFiles([...event.clipboardData.files], onPicture);
  });
  onChange(draw);
}
