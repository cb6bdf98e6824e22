// A row of buttons of which one is chosen, as a radio group: arrow keys move within it.
import {make} from "./dom.js";

export function segments(place, choices, chosen, told) {
  const buttons = choices.map(([value, ...text]) => make("button", {type: "button", role: "radio", "data-value": value, onclick: () => choose(value, true)}, ...text));
  function choose(value, tell) {
    for (const button of buttons) {
      const is = button.dataset.value === String(value);
      button.setAttribute("aria-checked", String(is));
      button.tabIndex = is ? 0 : -1;
    }
    if (!buttons.some((button) => button.tabIndex === 0)) buttons[0].tabIndex = 0;
    if (tell) told(value);
  }
  place.replaceChildren(...buttons);
  place.addEventListener("keydown", (event) => {
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
    if (!step) return;
    event.preventDefault();
    const next = buttons[(buttons.indexOf(document.activeElement) + step + buttons.length) % buttons.length];
    next.focus();
    next.click();
  });
  choose(chosen, false);
  return (value) => choose(value, false);
}
