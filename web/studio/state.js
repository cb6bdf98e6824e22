// The open and shown entries {id, name, material, model, parent, info, drawn, computed, seen}. `shown` is at the left
// and, where it is not null, `beside` at the right. `computed` is the share of the picture that the library computed.

const listeners = [];
let counter = 0;

export const state = {entries: [], shown: null, beside: null};

export const onChange = (listener) => listeners.push(listener);
export function changed(what = "entries") {
  for (const listener of listeners) listener(what);
}

export const entryOf = (id) => state.entries.find((entry) => entry.id === id) ?? null;
export const modelsOf = (entry) => state.entries.filter((other) => other.parent === entry.id);
// Returns the reference of a fit: an entry's own source, or itself.
export const referenceOf = (entry) => (entry && entry.parent !== null ? entryOf(entry.parent) : entry);
export const isSurface = (entry) => typeof entry?.material.place === "function";
// Returns the model whose shader is exported: the right one if it is a model, else the left one.
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
// Shows an entry just opened. A model stands beside the shown measurement, or a measurement beside the shown model.
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

// Closes an entry's material and, where that was edited, the original.
export function release({material, original}) {
  material.close?.();
  if (original !== material) original?.close?.();
}

// Closes an entry and the models fitted to it, which frees their memory.
export function remove(entry) {
  const gone = [entry, ...modelsOf(entry)];
  state.entries = state.entries.filter((e) => !gone.includes(e));
  gone.forEach(release);
  if (gone.includes(state.shown)) show(state.entries[0] ?? null);
  else if (gone.includes(state.beside)) showBeside(null);
  changed();
  for (const e of gone) changed({closed: e});
}
