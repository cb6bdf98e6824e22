import * as analytic from "./analytic.js";
import {find, say} from "./dom.js";
import * as edit from "./edit.js";
import * as figures from "./figures.js";
import * as fit from "./fit.js";
import * as info from "./info.js";
import {preload} from "./library.js";
import {openLink} from "./link.js";
import * as materials from "./materials.js";
import * as plots from "./plots.js";
import * as stage from "./stage.js";
import {onChange} from "./state.js";
import * as takeaway from "./takeaway.js";

const light = window.matchMedia("(prefers-color-scheme: light)");
function setTheme(name) {
  document.documentElement.dataset.theme = name;
  stage.themeChanged();
}
function switchTheme() {
  setTheme(document.documentElement.dataset.theme === "light" ? "dark" : "light");
  plots.redraw();
  fit.redraw();
}

document.documentElement.dataset.theme = light.matches ? "light" : "dark";
stage.start();
materials.start(stage.openPicture);
analytic.start();
plots.start();
fit.start();
figures.start();
edit.start();
takeaway.start();
info.start();
onChange(analytic.drawSliders);
light.addEventListener("change", () => setTheme(light.matches ? "light" : "dark"));
find("#theme").addEventListener("click", switchTheme);
find("#message-close").addEventListener("click", () => say(""));
window.addEventListener("keydown", (event) => event.key === "Escape" && say(""));
window.addEventListener("hashchange", openLink);
try {
  await preload();
  await openLink();
} catch (error) {
  say(`The library could not be loaded: ${error.message}`, "error");
}
