// Changes a model by sliders. Each change can be undone and redone.
import {isStopped, sayError, stoppable} from "./busy.js";
import {find, latest, make, replaceKeepingFocus} from "./dom.js";
import {infoOf} from "./library.js";
import {changed, isSurface, modelShown, onChange, state} from "./state.js";
import {radians} from "./vectors.js";

const fields = [
  ["scale", "Scale", -3, 3, 0, (x) => 2 ** x, (x) => `×${(2 ** x).toFixed(2)}`],
  ["hue", "Hue", -180, 180, 0, radians, (x) => `${Math.round(x)}°`],
  ["roughness", "Roughness", -1, 1, 0, (x) => 2 ** x, (x) => `×${(2 ** x).toFixed(2)}`],
  ["diffuse", "Diffuse", 0, 0.5, 0, (x) => x, (x) => `+${x.toFixed(2)}`],
];
const kBurst = 1000;  // milliseconds without a key that end a burst of keys
const ofLobes = ["scale", "hue"];  // sliders that each lobe has too

// Returns a slider's place: "hue" for all lobes, "hue:1" for one. A slider that was not moved has its default.
const placeOf = (places, [name, , , , still], lobe) => places?.[lobe === "" ? name : `${name}:${lobe}`] ?? still;

// Returns the options of `edit`: a number for all lobes, a list where one lobe has its own.
function optionsOf(places, lobes) {
  const options = {};
  for (const field of fields) {
    const [name, , , , still, value] = field, all = placeOf(places, field, "");
    const each = Array.from({length: ofLobes.includes(name) ? lobes : 0}, (_, k) => placeOf(places, field, k));
    if (each.some((at) => at !== still)) options[name] = each.map((at) => (name === "hue" ? value(all + at) : [value(all + at)]));
    else if (all !== still) options[name] = value(all);
  }
  return options;
}

// Returns true if a slider is away from its start.
const moved = ({places, lobes}) => Object.keys(optionsOf(places, lobes ?? 0)).length > 0;

// These are the states to undo and redo to: {entry, places}.
let past = [], future = [], shownFor, lobe = "";

const apply = latest(async (entry) => {
  if (!state.entries.includes(entry)) return;
  try {
    if (!entry.original) Object.assign(entry, {original: entry.material, lobes: entry.info.lobes, fitted: entry.name});
    const {original, places} = entry, options = optionsOf(places, entry.lobes), same = Object.keys(options).length === 0;
    const {material, info} = await stoppable(find("#edit"), "the edit", async (signal) => {
      const made = same ? original : await original.edit(options, {signal});
      return {material: made, info: await (same ? made.info({signal}) : infoOf(made, {signal}))};
    });
    // Meanwhile the entry may be closed or have another material.
    if (!state.entries.includes(entry) || entry.original !== original) {
      if (!same) material.close();
      return;
    }
    if (entry.material !== original && entry.material !== material) entry.material.close();
    Object.assign(entry, {material, info, applied: places, edited: !same, name: same ? entry.fitted : `${entry.fitted}, edited`});
    changed({renewed: entry});
  } catch (error) {
    if (isStopped(error)) takeBack(entry);
    sayError(error);
  }
});

// Moves sliders back to the shown state. No step of undoing leads to the abandoned one.
function takeBack(entry) {
  entry.places = entry.applied ?? {};
  for (const steps of [past, future])
    if (steps.at(-1)?.entry === entry && JSON.stringify(steps.at(-1).places) === JSON.stringify(entry.places)) steps.pop();
  draw(true);
}

function set(entry, places, remember) {
  if (remember) {
    past.push({entry, places: entry.places ?? {}});
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
    to.push({entry, places: entry.places ?? {}});
    set(entry, places, false);
    return;
  }
}

function draw(force) {
  const entry = modelShown(), able = entry?.info && !isSurface(entry), lobes = able ? (entry.lobes ?? entry.info.lobes) : 0;
  find("#undo").disabled = past.length === 0;
  find("#redo").disabled = future.length === 0;
  for (const button of document.querySelectorAll("#as-fitted")) button.disabled = !able || !moved(entry);
  const key = entry && `${entry.id} ${lobes}`;
  if (!force && shownFor === key) return;
  if (shownFor !== key) lobe = "";
  shownFor = key;
  // One step back is one drag, or one burst of keys. Only its start is remembered.
  let before = null, keyed = false, burst = null, ending;
  const shown = fields.filter(([name]) => lobe === "" || ofLobes.includes(name));
  replaceKeepingFocus(find("#edit"), lobeChoice(lobes), ...shown.map((field) => {
    const [name, title, least, most, , , text] = field, place = placeOf(entry?.places, field, lobe), gray = name === "hue" && entry?.material.channels !== 3;
    const output = make("output", {}, text(place));
    const input = make("input", {type: "range", min: least, max: most, step: (most - least) / 200, value: place, "data-edit": name, disabled: !able || gray,
      oninput: () => {
        before ??= {...entry.places};
        entry.places = {...entry.places, [lobe === "" ? name : `${name}:${lobe}`]: Number(input.value)};
        output.textContent = text(Number(input.value));
        apply(entry);
      },
      onkeydown: () => (keyed = true),
      onchange: () => {
        if (!before) return;
        if (!keyed || burst !== name) past.push({entry, places: before});
        burst = keyed ? name : null;
        keyed = false;
        clearTimeout(ending);
        ending = setTimeout(() => (burst = null), kBurst);
        future = [];
        before = null;
        find("#undo").disabled = find("#as-fitted").disabled = false;
        find("#redo").disabled = true;
      }});
    return make("label", {}, make("span", {}, title), input, output);
  }), make("button", {type: "button", class: "quiet", id: "as-fitted", disabled: !able || !moved(entry), onclick: () => set(entry, {}, true)}, "As fitted"));
}

// Chooses all lobes or one of several.
function lobeChoice(lobes) {
  const numbers = Array.from({length: lobes}, (_, k) => make("option", {value: k}, `lobe ${k + 1}`));
  const select = make("select", {"data-edit": "lobe", disabled: !(lobes > 1), onchange: () => {
    lobe = select.value;
    draw(true);
  }}, make("option", {value: ""}, "all lobes"), ...numbers);
  select.value = lobe;
  return make("label", {}, make("span", {}, "Of"), select, make("output"));
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
  onChange((what) => {
    if (what.closed) [past, future] = [past, future].map((steps) => steps.filter(({entry}) => entry !== what.closed));
    draw(what === "shown");
  });
}
