// Keeps the figures of `compare` by the two materials. An edited material, or one read in another way, has figures of
// its own. After an undo the old ones serve again.
import {isStopped, stoppable} from "./busy.js";
import {find, latest, lineOf} from "./dom.js";
import {changed, isSurface, onChange, state} from "./state.js";

const kRest = 300;  // milliseconds that a pair rests before it is measured
const known = new WeakMap();
let resting;

// Returns {figures}, or {wrong} where there are none, or undefined where the pair was not measured yet.
export const judgedOf = (reference, entry) => known.get(reference.material)?.get(entry.material);
export function remember(reference, material, judged) {
  if (!known.has(reference)) known.set(reference, new WeakMap());
  known.get(reference).set(material, judged);
}

const measure = latest(async () => {
  const {shown, beside} = state;
  if (!shown?.info || !beside?.info || isSurface(shown) || isSurface(beside) || judgedOf(shown, beside)) return;
  const reference = shown.material, {material} = beside;
  try {
    const [figures] = await stoppable(find("#figures"), "measuring the error", (signal) => reference.compare(material, {}, {signal}));
    remember(reference, material, {figures});
  } catch (error) {
    remember(reference, material, {wrong: isStopped(error) ? "stopped" : lineOf(error)});
  }
  changed();
});

export function start() {
  onChange((what) => {
    if (what === "judged") return;
    clearTimeout(resting);
    resting = setTimeout(measure, kRest);
  });
}
