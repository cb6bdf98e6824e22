// Makes the buttons of a row a radio group: one is chosen, and arrow keys move within it. Returns a function that
// chooses a button without calling told. A value that no button has chooses none.
export function segments(place, told) {
  const buttons = [...place.children];
  function choose(value) {
    for (const button of buttons) {
      const is = button.dataset.value === value;
      button.setAttribute("aria-checked", String(is));
      button.tabIndex = is ? 0 : -1;
    }
    if (!buttons.some((button) => button.tabIndex === 0)) buttons[0].tabIndex = 0;
  }
  for (const button of buttons)
    button.addEventListener("click", () => {
      choose(button.dataset.value);
      told(button.dataset.value);
    });
  place.addEventListener("keydown", (event) => {
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key], able = buttons.filter((button) => !button.disabled);
    if (!step) return;
    event.preventDefault();
    const next = able[(able.indexOf(document.activeElement) + step + able.length) % able.length];
    next.focus();
    next.click();
  });
  choose(buttons.find((button) => button.getAttribute("aria-checked") === "true")?.dataset.value);
  return choose;
}
