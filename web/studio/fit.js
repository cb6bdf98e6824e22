// Runs fits with progress and stop, and shows their figures beside the reference's, and error against bytes.
import {plot} from "./chart.js";
import {bytesText, css, find, lineOf, make, number, row, say, table} from "./dom.js";
import {judgedOf, remember} from "./figures.js";
import {incidence} from "./info.js";
import {infoOf} from "./library.js";
import {segments} from "./segments.js";
import {add, changed, isSurface, onChange, referenceOf, show, showBeside, state} from "./state.js";

const presets = {
  small: {budget: "2700", fetches: ""},
  default: {budget: "16K", fetches: "2"},
  best: {budget: "64K", fetches: ""},
};
const kCurve = [700, 1400, 2800, 5600, 11200, 22400, 44800];
const kMaxFits = 4;  // at once, each with memory of its own
// The hint explains bytes and fetches, and the cost of leaving fetches open.
const kHint = "2700, 16K, 1M or auto. Fetches: filtered reads a light";
const kOpen = "; an empty field allows as many as lower the error, which may be 20 and more.";
const kNothing = 1e-9;  // smaller figures are roundings

let stop = null, fitted = null, choose = () => {}, showResults = () => {}, followed = null;

// Returns the typed text, which the library reads or refuses. Without fetches, or with "auto", the library chooses
// them.
const typedBudget = () => find("#budget").value.trim().toLowerCase();
function typedFetches() {
  const text = find("#fetches").value.trim();
  if (text === "" || /^auto$/i.test(text)) return undefined;
  return Number.isFinite(Number(text)) ? Number(text) : text;
}

// Returns true for the default preset, whose fetches depend on the material.
const isDefault = () => find("#presets [data-value=default]").getAttribute("aria-checked") === "true";

// Returns the target of a fit where there is a choice.
const targetOf = (reference) => reference.material.measurement ? find("#target").value : undefined;

function progress(fraction, stage) {
  if (stage) find("#fit-stage").textContent = stage;
  if (Number.isFinite(fraction)) find("#fit-bar").value = fraction;
}

// Runs the task with a signal. The stop button, the task itself, and the end of the fitted entry abort it. Shows
// errors, except that of an abort.
async function busy(reference, task) {
  const mine = (stop = new AbortController());
  fitted = reference;
  find("#fit-bar").removeAttribute("value");
  find("#fit-stage").textContent = "starting";
  find("#fitting").hidden = false;
  enable();
  try {
    await task(mine.signal, () => mine.abort());
  } catch (error) {
    if (error?.name === "AbortError") say("Stopped");
    else say(lineOf(error), "error");
  } finally {
    stop = fitted = null;
    find("#fitting").hidden = true;
    enable();
  }
}

async function fitOne(reference, options, signal) {
  const began = performance.now(), source = reference.material;
  const material = await source.fit(options, {onProgress: progress, signal});
  const seconds = (performance.now() - began) / 1000;
  find("#fit-stage").textContent = "measuring the error";
  find("#fit-bar").removeAttribute("value");
  const info = await infoOf(material, {signal});
  let figures;
  try {
    [figures] = await source.compare(material, {}, {signal});
    remember(source, material, {figures});
  } catch (error) {
    material.close();
    throw error;
  }
  const name = `${reference.name.replace(/\.[a-z]\w*(?=,|$)/i, "")} ${bytesText(info.bytes)}`;
  return {figures, entry: {name, material, info, parent: reference.id, seconds}};
}

async function fit(event) {
  event.preventDefault();
  const reference = referenceOf(state.shown);
  if (!reference || isSurface(reference) || stop) return;
  await busy(reference, async (signal) => {
    // The fields hold the options, also those of the default.
    const options = {target: targetOf(reference), budget: typedBudget(), fetches: typedFetches()};
    const {entry} = await fitOne(reference, options, signal);
    if (!state.entries.includes(reference)) {
      entry.material.close?.();
      return;
    }
    add(entry);
    changed();
    show(entry);
    showResults("figures");
  });
}

// Fits each size once, as many at a time as there are processors to spare. A stop keeps the fits that are done. A
// failed fit ends all.
async function errorCurve() {
  const reference = referenceOf(state.shown);
  if (!reference || stop) return;
  reference.curve = [];
  drawCurve();
  await busy(reference, async (signal, abort) => {
    const fetches = typedFetches(), target = targetOf(reference), left = [...kCurve];
    let wrong;
    const failed = (error) => {
      wrong ??= error;
      abort();
    };
    const one = async () => {
      for (let budget; (budget = left.shift()) !== undefined;) {
        const {entry, figures} = await fitOne(reference, {budget, fetches, target}, signal);
        entry.material.close?.();
        reference.curve.push({bytes: entry.info.bytes, psnr: figures.psnr});
        reference.curve.sort((a, b) => a.bytes - b.bytes);
        drawCurve();
      }
    };
    // A fit with threads takes all processors by itself.
    const workers = globalThis.crossOriginIsolated ? 1 : Math.min(Math.max((navigator.hardwareConcurrency ?? 2) - 1, 1), kMaxFits);
    await Promise.all(Array.from({length: workers}, () => one().catch(failed)));
    if (wrong) throw wrong;
  });
  changed();
}

function drawCurve() {
  const curve = referenceOf(state.shown)?.curve ?? [];
  const psnr = curve.map((p) => p.psnr), [low, high] = curve.length ? [Math.floor(Math.min(...psnr) - 1), Math.ceil(Math.max(...psnr) + 1)] : [20, 60];
  find("#bytes-curve").replaceChildren(plot({
    label: "Picture error in decibels against bytes", x: [500, 80_000], logX: true, xTicks: [1024, 4096, 16384, 65536], xTick: bytesText, y: [low, high],
    xName: "bytes", yName: "PSNR, dB", lines: [{x: curve.map((p) => p.bytes), values: psnr, color: css("--accent"), dots: true}],
  }));
}

// Shows a figure with few digits, and with all of them as its title.
const figure = (x, digits) => make("span", {title: x}, number(Math.abs(x) < kNothing ? 0 : x, digits));

// The explanations of the figures, shown as titles and below the table.
const kExplained = {
  PSNR: "similarity of pictures of lit spheres in decibels; more is better",
  SSIM: "similarity of their structures; 1 is equal",
  relative: "mean ratio of both values less 1: 0.1 is a mean difference of 10 %",
  "rms log": "root mean square of that ratio's logarithm; large errors add more",
  "log cos": "mean difference of ln(1 + f cos θi); dark values add little",
};
const explained = (name) => make("abbr", {title: kExplained[name]}, name);
const explanations = () => make("details", {}, make("summary", {}, "What the figures are"),
  make("dl", {}, ...Object.entries(kExplained).flatMap(([name, text]) => [make("dt", {}, name), make("dd", {}, `${text}.`)])));

// Shortens a long name in the middle, since the ends of names distinguish fits of one file.
const shortened = (name) => make("span", {class: "name", title: name}, name.length > 17 ? `${name.slice(0, 8)}…${name.slice(-8)}` : name);

// Shows the expected error of a model of scattered samples by incidence, at measured and other directions.
function expectedTable(expected, ofReference, ofModel) {
  const bands = Object.keys(expected.itself.from_theta_i_deg);
  const values = ({relative, from_theta_i_deg: by}) => [relative, ...bands.map((band) => by[band])].map((x) => (x === undefined ? "" : figure(x, 3)));
  return table("Expected relative error, measured or not", ["of", "all", ...bands.map((band) => `θi ${band}°+`)],
               [row([ofReference, ...values(expected.itself)]), row([ofModel, ...values(expected)])]);
}

// Shows compare's further figures of a model: albedos, and figures at nodes where something was measured.
function moreFigures(reference, model, {albedo, nodes, expected, unknown_fraction: unknown, unknown_pixels: pixels}) {
  const mean = (values) => values.reduce((sum, x) => sum + x, 0) / values.length;
  const names = () => [shortened(reference.name), shortened(model.name)], [ofReference, ofModel] = names();
  const albedos = albedo.map((at) => row([incidence(at), figure(mean(at.reference), 4), figure(mean(at.model), 4)]));
  const scores = ({relative, rms_log, log_cos, rms}) => [relative, rms_log, log_cos, rms].map((x) => figure(x, 3));
  return [
    table("Mean of the channels", ["at", ...names()], albedos),
    nodes ? table(`At ${nodes.count.toLocaleString("en")} measured nodes`, ["of", "relative", "rms log", "log cos", "rms"],
                  [row([ofReference, ...scores(nodes.itself)]), row([ofModel, ...scores(nodes)])]) : "",
    expected ? expectedTable(expected, ...names()) : "",
    unknown > 0 || pixels > 0 ? make("p", {class: "hint"}, `Left out, where a material has no value: ${number(100 * unknown, 3)} % of the directions and ${pixels} pixels.`) : "",
  ];
}

// Returns the fits of a reference, the entry beside it, and entries that were beside it before.
const comparedWith = (reference) => state.entries.filter((entry) => reference && entry !== reference && entry.info && !isSurface(entry) && !isSurface(reference) &&
  (entry.parent === reference.id || entry === state.beside || judgedOf(reference, entry)));

function drawFigures() {
  const reference = referenceOf(state.shown), place = find("#figures"), models = comparedWith(reference);
  if (!models.length) {
    place.replaceChildren(make("p", {class: "hint"}, "This panel shows the figures of each fit beside its source, and the cost of its shader."));
    find("#compared").replaceChildren(make("p", {class: "hint"}, "This panel shows albedo and errors of materials beside each other."));
    return;
  }
  const heads = ["Model", ...Object.keys(kExplained).map(explained)];
  const rows = models.map((model) => {
    const f = judgedOf(reference, model)?.figures ?? {};  // an edited model has no figures yet
    return row([make("button", {type: "button", title: model.name, onclick: () => showBeside(model)}, model.model ? bytesText(model.info.bytes) : model.name),
                ...[f.psnr === null ? Infinity : f.psnr, f.ssim, f.relative, f.rms_log, f.log_cos].map((x, k) => figure(x, k === 0 ? 4 : 3))], {"data-shown": model === state.beside});
  });
  const model = models.includes(state.beside) ? state.beside : models.at(-1), {figures, wrong} = judgedOf(reference, model) ?? {}, cost = model.info.shader;
  const many = (count, what) => `${count} ${what}${count === 1 ? "" : what.endsWith("ch") ? "es" : "s"}`;
  const costText = cost && `${model.name}: ${many(cost.fetches, "fetch")} of ${many(cost.textures, "texture")}, ${many(cost.operations, "operation")}, ` +
    `${many(cost.divisions, "division")}, ${many(cost.roots, "root")}, ${many(cost.powers, "power")} a light.${model.seconds && !model.edited ? ` Fitted in ${number(model.seconds, 2)} s.` : ""}`;
  place.replaceChildren(
    make("div", {class: "scroll", tabindex: 0, role: "region", "aria-label": "Figures of the models"}, table("", heads, rows)),
    explanations(),
    wrong ? make("p", {class: "hint"}, `${model.name} has no figures: ${wrong}`) : "",
    cost ? make("p", {class: "cost"}, costText) : "");
  find("#compared").replaceChildren(...(figures ? moreFigures(reference, model, figures) : []));
}

function enable() {
  const able = referenceOf(state.shown) !== null && !isSurface(state.shown) && !stop;
  find("#fit-start").disabled = find("#curve-start").disabled = !able;
}

export function start() {
  const budget = find("#budget"), fetches = find("#fetches");
  const hint = () => (find("#fit-hint").textContent = kHint + (fetches.value.trim() === "" ? kOpen : "."));
  choose = segments(find("#presets"), (name) => {
    budget.value = presets[name].budget;
    fetches.value = presets[name].fetches;
    hint();
  });
  const shown = (name) => [find("#figures").hidden, find("#curve-place").hidden] = [name !== "figures", name !== "curve"];
  const chosen = segments(find("#results"), shown);
  showResults = (name) => {
    chosen(name);
    shown(name);
  };
  // The default takes six fetches for an anisotropic source.
  const setFetches = () => {
    presets.default.fetches = referenceOf(state.shown)?.material.isotropic === false ? "6" : "2";
    if (isDefault()) fetches.value = presets.default.fetches;
    hint();
  };
  // Typed values are used as they stand. The default is chosen by its button alone.
  const other = () => {
    choose(Object.keys(presets).find((name) => name !== "default" && presets[name].budget === budget.value.trim() && presets[name].fetches === fetches.value.trim()));
    hint();
  };
  budget.addEventListener("input", other);
  fetches.addEventListener("input", other);
  find("#fit").addEventListener("submit", fit);
  find("#fit-stop").addEventListener("click", () => stop?.abort());
  find("#curve-start").addEventListener("click", errorCurve);
  redraw();
  onChange((what) => {
    enable();
    drawFigures();
    if (what.closed && what.closed === fitted) stop?.abort();
    if (what.renewed) setFetches();
    if (what === "shown") {
      drawCurve();
      const material = referenceOf(state.shown)?.material;
      find("#target").disabled = !material?.measurement;
      if (material && material !== followed) find("#target").value = material.target;
      followed = material;
      setFetches();
    }
  });
}
export const redraw = () => {
  drawCurve();
  drawFigures();
};
