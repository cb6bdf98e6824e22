// What takes long: a bar in the corner of a panel, and a button that stops it.
import {lineOf, make, say} from "./dom.js";

const kLong = 150;  // milliseconds after which it is shown

// What task(signal) gives, which the button aborts.
export async function stoppable(place, what, task) {
  const stop = new AbortController();
  const bar = make("div", {class: "busy"}, make("progress", {"aria-label": what}),
    make("button", {type: "button", class: "quiet", "aria-label": `Stop ${what}`, onclick: () => stop.abort()}, "Stop"));
  const timer = setTimeout(() => place.closest(".panel").append(bar), kLong);
  try {
    return await task(stop.signal);
  } finally {
    clearTimeout(timer);
    bar.remove();
  }
}

export const isStopped = (error) => error?.name === "AbortError";

// Says what was thrown, in one line.
export function sayError(error) {
  if (isStopped(error)) say("Stopped");
  else say(lineOf(error), "error");
}
