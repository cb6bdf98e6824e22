// Shows long tasks by a bar in the corner of a panel, with a button that stops them.
import {lineOf, make, say} from "./dom.js";

const kLong = 150;  // milliseconds before the bar is shown

// Returns the result of task(signal). The button aborts the signal.
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

// Shows a thrown error in one line.
export function sayError(error) {
  if (isStopped(error)) say("Stopped");
  else say(lineOf(error), "error");
}
