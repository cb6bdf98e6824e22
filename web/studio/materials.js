// Opens and lists materials: files dropped, chosen or pasted, analytic models, the sample, links.
import {isStopped, sayError, stoppable} from "./busy.js";
import {bytesText, find, latest, lineOf, make, replaceKeepingFocus, say} from "./dom.js";
import {infoOf, open} from "./library.js";
import {add, changed, entryOf, onChange, release, remove, show, showBeside, showOpened, state} from "./state.js";

let stop = null;                // aborts the present opening
let opens = Promise.resolve();  // ends with the last request

const kNamed = 4;  // files named that could not be opened, beside the first
const kMaxChoices = 5000;  // materials of one file in the list

// Runs tasks one after another in their order, so the first file dropped is opened first.
function queued(task) {
  const mine = opens.then(task);
  opens = mine.catch(() => {});
  return mine;
}

// Opens a BRDF, adds it to the list and shows it. Throws the error of opening.
async function opening(data, name, more, options) {
  const mine = (stop = new AbortController());
  const bar = find("#opening-bar");
  bar.removeAttribute("value");
  find("#opening-text").textContent = name;
  find("#opening").hidden = false;
  let entry;
  try {
    const onProgress = (fraction) => (bar.value = fraction);
    const material = await open(data, {...options, name, signal: mine.signal, onProgress});
    entry = add({name, material, info: null, ...more});
    const wanted = reader(entry, data, name, options);
    if (material.entries.length) entry.sliders = [chooser(entry, wanted)];
    changed();
    showOpened(entry);
    // The full information takes longer than the picture.
    bar.removeAttribute("value");
    find("#opening-text").textContent = `${name}: reading its properties`;
    entry.info = await material.info({signal: mine.signal});
    entry.readings = readings(entry, wanted);
  } catch (error) {
    if (state.entries.includes(entry)) remove(entry);
    throw error;
  } finally {
    stop = null;
    find("#opening").hidden = true;
  }
  changed();
  return entry;
}

const wrong = (error, name) => (lineOf(error).includes(name) ? lineOf(error) : `${name}: ${lineOf(error)}`);

// Does the same, but shows an error or a stop and returns null.
export async function openOne(data, name, more = {}, options = {}) {
  try {
    return await queued(() => opening(data, name, more, options));
  } catch (error) {
    if (isStopped(error)) say("Stopped");
    else say(wrong(error, name), "error");
    return null;
  }
}

// Gives an entry another material, the latest that made(signal) opened, then calls done(). Calls undo() where it could
// not be made or was stopped.
export function renewer(entry, made, {done, undo, name = () => entry.name}) {
  return latest(async () => {
    if (!state.entries.includes(entry)) return;
    try {
      const called = name();
      const {material, info} = await stoppable(find("#list"), "reading", async (signal) => {
        const opened = await made(signal);
        return {material: opened, info: await infoOf(opened, {signal})};
      });
      if (!state.entries.includes(entry)) {
        material.close();
        return;
      }
      release(entry);
      Object.assign(entry, {name: called, material, info, original: undefined, places: undefined});
      done();
      changed({renewed: entry});
    } catch (error) {
      undo();
      sayError(error);
    }
  });
}

// Reads an entry's file again, another way: {how, last, renew, undone}. After a failure the last readable way stays,
// and functions in `undone` are called.
function reader(entry, data, file, options) {
  const how = {...options}, last = {...options}, undone = [];
  let asked;
  const renew = renewer(entry, (signal) => open(data, {...(asked = {...how}), name: file, signal}), {
    done: () => Object.assign(last, asked),
    undo: () => {
      Object.assign(how, last);
      undone.forEach((tell) => tell());
    },
    name: () => (how.entry ? `${file}#${how.entry}` : file),
  });
  return {how, last, renew, undone};
}

// Returns a list or a box that sets how[name].
function choice(title, name, input, {how, last, renew, undone}, aside = "") {
  const box = input.type === "checkbox", before = box ? input.checked : input.value;
  input.dataset.reading = name;
  input.addEventListener("change", () => {
    how[name] = box ? input.checked : input.value;
    renew();
  });
  last[name] = how[name] ??= before;
  undone.push(() => (input[box ? "checked" : "value"] = how[name]));
  return make("label", {}, make("span", {}, title), input, make("output", {}, aside));
}
const listOf = (values) => make("select", {}, ...values.map((value) => make("option", {value}, value)));

// Chooses one of several materials of a file.
const chooser = ({material: {entries}}, wanted) =>
  choice("Material", "entry", listOf(entries.slice(0, kMaxChoices)), wanted, String(entries.length));

// Returns controls for the options that a format leaves open: the light of spectra, the side, the cosine in values.
function readings({info}, wanted) {
  const box = () => make("input", {type: "checkbox"}), choices = [];
  if (info.illuminant) choices.push(choice("Light", "illuminant", listOf(["E", "D50", "D65", "A"]), wanted));
  if (/^(measured )?(Klems|tensor tree)/.test(info.format)) choices.push(choice("Back side", "back", box(), wanted));
  if (/^(measured )?CSV/.test(info.format)) choices.push(choice("Times cos", "hasCosine", box(), wanted));
  return choices;
}

// Opens files, with one message for all that are no BRDF. A stop leaves out the later files, and says so. A decoder of
// Neural Processes belongs to the codes beside it.
const openFiles = (files, onPicture) => queued(() => openEach(files, onPicture));
async function openEach(files, onPicture) {
  const decoder = files.find(({name}) => /\.f32$/i.test(name)), codes = decoder && files.find(({name}) => /\.csv$/i.test(name)), said = [];
  const wanted = files.filter((f) => !codes || f !== decoder);
  if (find("#message").dataset.kind === "error") say("");  // clears the error of an earlier attempt
  for (const [k, file] of wanted.entries()) {
    try {
      if (/\.(hdr|exr)$/i.test(file.name) && (await onPicture(file))) continue;
      await opening(file, file.name, {}, file === codes ? {decoder} : {});
    } catch (error) {
      if (isStopped(error)) {
        if (!said.length) say(k + 1 < wanted.length ? `Stopped: ${wanted.length - k} of ${wanted.length} files were not opened` : "Stopped");
        break;
      }
      said.push({name: file.name, text: wrong(error, file.name)});
    }
  }
  if (!said.length) return;
  const [first, ...others] = said, names = others.slice(0, kNamed).map(({name}) => name).join(", ") + (others.length > kNamed ? " …" : "");
  say(others.length ? `${first.text} (and ${others.length} more of ${files.length} files could not be opened: ${names})` : first.text, "error");
}

function subtitle({info, parent}) {
  if (!info) return "…";
  if (info.width) return `surface, ${info.width} × ${info.height}`;
  if (parent !== null) return `${bytesText(info.bytes)} model`;
  return info.bytes ? `${info.format}, ${bytesText(info.bytes)}` : info.format;
}

function row(entry) {
  const picture = (entry.picture ??= make("canvas", {width: 80, height: 80, "aria-hidden": "true"}));
  const shown = entry === state.shown || entry === state.beside;
  return make("li", {class: entry.parent !== null ? "model" : "", "data-shown": shown, "data-of": entry.id},
    make("button", {class: "pick", type: "button", title: entry.name, "aria-pressed": String(shown), onclick: () => show(entry)},
         picture, make("span", {}, make("b", {}, entry.name), make("small", {}, subtitle(entry)))),
    make("button", {class: "close", type: "button", "aria-label": `Close ${entry.name}`, title: "Close", onclick: () => remove(entry)}, "×"));
}

function draw() {
  const list = find("#list"), at = [...list.children].findIndex((before) => before.contains(document.activeElement));
  // After a row is gone, the next row's button gets the focus, or at last the button that opens files.
  if (!replaceKeepingFocus(list, ...(state.entries.length ? state.entries.map(row) : [make("li", {class: "hint"}, "Nothing is open.")])))
    ((list.children[at] ?? list.lastElementChild).querySelector(".close") ?? find("#choose")).focus();
  // The shown rows are scrolled into sight.
  const rows = [...list.querySelectorAll("[data-shown]")], [first, last] = [rows[0], rows.at(-1)];
  if (first) list.scrollTop = Math.min(first.offsetTop, Math.max(list.scrollTop, last.offsetTop + last.offsetHeight - list.clientHeight));
  const beside = find("#beside");
  beside.replaceChildren(make("option", {value: ""}, "nothing beside"),
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

  // Files may be dropped anywhere on the page.
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
  draw();
  onChange((what) => what !== "judged" && draw());
}
