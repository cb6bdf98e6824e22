// Changes to a model by sliders, each one undone and redone.
import {find, latest, lineOf, make, say} from "./dom.js";
import {changed, modelShown, onChange, state} from "./state.js";
import {radians} from "./vectors.js";

const fields = [
  ["scale", "Scale", -3, 3, 0, (x) => 2 ** x, (x) => `×${(2 ** x).toFixed(2)}`],
  ["hue", "Hue", -180, 180, 0, radians, (x) => `${Math.round(x)}°`],
  ["roughness", "Roughness", -1, 1, 0, (x) => 2 ** x, (x) => `×${(2 ** x).toFixed(2)}`],
  ["diffuse", "Diffuse", 0, 0.5, 0, (x) => x, (x) => `+${x.toFixed(2)}`],
];
const untouched = () => Object.fromEntries(fields.map(([name, , , , still]) => [name, still]));

// States to go back and forth to: {entry, places}.
let past = [], future = [], shownFor;

const apply = latest(async (entry) => {
  try {
    entry.original ??= entry.material;
    const places = {...entry.places};
    const moved = fields.filter(([name, , , , at]) => places[name] !== at);
    const options = Object.fromEntries(moved.map(([name, , , , , value]) => [name, value(places[name])]));
    const material = moved.length === 0 ? entry.original : await entry.original.edit(options);
    const info = await material.info();
    if (!state.entries.includes(entry)) return;
    if (entry.material !== entry.original && entry.material !== material) entry.material.close?.();
    Object.assign(entry, {material, info});
    changed({renewed: entry});
  } catch (error) {
    say(lineOf(error), "error");
  }
});

function set(entry, places, remember) {
  if (remember) {
    past.push({entry, places: entry.places ?? untouched()});
    future = [];
  }
  entry.places = places;
  draw(true);
  apply(entry);
}

function step(from, to) {
  while (from.length) {
    const {entry, places} = from.pop();
    if (!state.entries.includes(entry)) continue;
    to.push({entry, places: entry.places ?? untouched()});
    set(entry, places, false);
    return;
  }
}

function draw(force) {
  const entry = modelShown(), able = typeof entry?.material.edit === "function";
  find("#undo").disabled = past.length === 0;
  find("#redo").disabled = future.length === 0;
  if (!force && shownFor === entry) return;
  shownFor = entry;
  const places = entry?.places ?? untouched();
  // one step back is one drag: where it began is remembered, not each place between
  let before = null;
  find("#edit").replaceChildren(...fields.map(([name, title, least, most, , , text]) => {
    const output = make("output", {}, text(places[name]));
    const input = make("input", {type: "range", min: least, max: most, step: (most - least) / 200, value: places[name], "data-edit": name, disabled: !able,
      oninput: () => {
        before ??= {...(entry.places ?? untouched())};
        entry.places = {...(entry.places ?? untouched()), [name]: Number(input.value)};
        output.textContent = text(Number(input.value));
        apply(entry);
      },
      onchange: () => {
        if (!before) return;
        past.push({entry, places: before});
        future = [];
        before = null;
        find("#undo").disabled = false;
        find("#redo").disabled = true;
      }});
    return make("label", {}, make("span", {}, title), input, output);
  }), make("button", {type: "button", class: "quiet", disabled: !able, onclick: () => set(entry, untouched(), true)}, "As fitted"));
}

export function start() {
  find("#undo").addEventListener("click", () => step(past, future));
  find("#redo").addEventListener("click", () => step(future, past));
  window.addEventListener("keydown", (event) => {
    const typing = event.target instanceof HTMLInputElement && event.target.type === "text";
    if (typing || !(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
    event.preventDefault();
    if (event.shiftKey) step(future, past);
    else step(past, future);
  });
  draw();
  onChange((what) => draw(what === "shown"));
}
