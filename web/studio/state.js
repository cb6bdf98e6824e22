// What is open and what is shown: entries {id, name, material, model, parent, info, drawn, computed, seen}, `shown` at the
// left and, where it is not null, `beside` it at the right. `computed`: how much of the picture the library did.

const listeners = [];
let counter = 0;

export const state = {entries: [], shown: null, beside: null};

export const onChange = (listener) => listeners.push(listener);
export function changed(what = "entries") {
  for (const listener of listeners) listener(what);
}

export const entryOf = (id) => state.entries.find((entry) => entry.id === id) ?? null;
export const modelsOf = (entry) => state.entries.filter((other) => other.parent === entry.id);
// What a fit is compared with: an entry's own source, or itself.
export const referenceOf = (entry) => (entry && entry.parent !== null ? entryOf(entry.parent) : entry);
export const isSurface = (entry) => typeof entry?.material.place === "function";
// The model whose shader is given away: the right one if it is a model, else the left one.
export const modelShown = () => [state.beside, state.shown].find((entry) => entry?.model) ?? null;

export function add(entry) {
  entry.id = ++counter;
  entry.model = typeof entry.material.shader === "function";
  entry.parent ??= null;
  const family = entry.parent === null ? -1 : state.entries.findLastIndex((e) => e.id === entry.parent || e.parent === entry.parent);
  state.entries.splice(family < 0 ? state.entries.length : family + 1, 0, entry);
  return entry;
}

export function show(entry) {
  if (entry && entry.parent !== null && entryOf(entry.parent)) [state.shown, state.beside] = [entryOf(entry.parent), entry];
  else [state.shown, state.beside] = [entry, entry ? modelsOf(entry).at(-1) ?? null : null];
  changed("shown");
}
// What was opened just now: a model and a measurement side by side where the other one is shown.
export function showOpened(entry) {
  const {shown} = state, isModel = (of) => of.model && !isSurface(of);
  if (shown?.material.measurement && isModel(entry)) [state.shown, state.beside] = [shown, entry];
  else if (shown && entry.material.measurement && isModel(shown)) [state.shown, state.beside] = [entry, shown];
  else return show(entry);
  changed("shown");
}
export function showBeside(entry) {
  state.beside = entry === state.shown ? null : entry;
  changed("shown");
}

// Closes what an entry has open: its material and, where that was edited, what it was made of.
export function release({material, original}) {
  material.close?.();
  if (original !== material) original?.close?.();
}

// Closes an entry and the models fitted to it; their memory is given back.
export function remove(entry) {
  const gone = [entry, ...modelsOf(entry)];
  state.entries = state.entries.filter((e) => !gone.includes(e));
  gone.forEach(release);
  if (gone.includes(state.shown)) show(state.entries[0] ?? null);
  else if (gone.includes(state.beside)) showBeside(null);
  changed();
  for (const e of gone) changed({closed: e});
}
