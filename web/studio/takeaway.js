// Exports: shaders, files, pictures, a link.
import {sayError, stoppable} from "./busy.js";
import {bytesText, css, find, make, pageWords, replaceKeepingFocus, saveFile, say} from "./dom.js";
import {linkOf} from "./link.js";
import {isSurface, modelShown, onChange, referenceOf, state} from "./state.js";
import {picture} from "./stage.js";
import {zip} from "./zip.js";

const languages = {glsl: "GLSL 4.50", glsl_es: "GLSL ES 3.00", hlsl: "HLSL", slang: "Slang", wgsl: "WGSL", msl: "Metal", cpp: "C++"};
const modelFiles = {burnish: ".burnish", model: "OpenEXR", ktx2: "KTX2 textures", three: "three.js", babylon: "Babylon.js", html: "Page", gltf: "glTF",
                    materialx: "MaterialX", usda: "USD", mdl: "MDL"};
// The files that OpenPBR goes to without a fit, besides shaders.
const openPbrFiles = {materialx: "MaterialX", usda: "USD", gltf: "glTF", three: "three.js", babylon: "Babylon.js", html: "Page"};
const surfaceFiles = {burnish: ".burnish", ktx2: "KTX2 textures", png: "PNG maps", three: "three.js", html: "Page", gltf: "glTF"};
// Formats of any material, and the endings of names.
const anyFiles = {merl: "MERL", utia: "UTIA", rgl: "RGL", mbsdf: "MBSDF", zemax: "Zemax", tensortree: "Tensor tree", klems: "Klems", speos: "Speos", openmaterial: "OpenMATERIAL",
                  astm: "ASTM", csv: "CSV", exr: "EXR slices"};
const kExtensions = {merl: "binary", utia: "bin", rgl: "bsdf", zemax: "zemax.bsdf", tensortree: "xml", klems: "klems.xml", speos: "anisotropicbsdf", openmaterial: "xompt", model: "exr"};
const kLongLink = 32 << 10;

let language = "glsl_es", textOpen = false;

// Returns a name for files and functions: letters, digits and single underscores, a letter first. An ending begins with
// a letter, so that of 2.4 KB is none.
function stem(entry) {
  const words = entry.name.replace(/\.[a-z]\w*$/i, "").split(/[^a-z0-9]+/i).filter(Boolean).join("_").slice(0, 60).replace(/_$/, "");
  return /^[a-z]/i.test(words) ? words : ["brdf", words].filter(Boolean).join("_");
}

// Returns an export's files {name, bytes}. An export gives bytes or files.
async function filesOf(entry, kind, signal) {
  const onLosses = (losses) => say(pageWords(`${entry.name} as ${kind}: lost: ${losses.join("; ")}`));
  const made = await entry.material.export(kind, {name: stem(entry)}, {signal, onLosses});
  if (!Array.isArray(made)) return [{name: `${stem(entry)}.${kExtensions[kind] ?? kind}`, bytes: made}];
  // OpenPBR has no textures, which a manifest would tell of.
  return entry.spec === "openpbr" ? made.filter(({name}) => !name.endsWith(".json")) : made;
}

// Runs a button's task with a signal that ends it.
const guarded = (task) => async (event) => {
  const button = event.currentTarget, focused = document.activeElement === button;
  button.disabled = true;
  try {
    await stoppable(find("#take"), "the export", task);
  } catch (error) {
    sayError(error);
  } finally {
    button.disabled = false;
    if (focused && document.activeElement === document.body) button.focus();
  }
};

const saveButton = (entry, kind, title) =>
  make("button", {type: "button", "data-export": kind, onclick: guarded(async (signal) => {
    const files = await filesOf(entry, kind, signal), [{name, bytes}] = files;
    if (files.length === 1) saveFile(name, bytes);
    else saveFile(`${stem(entry)}.${kind}.zip`, await zip(files));
  })}, title);

// Returns true if the text was copied. Pages that are not served securely have no clipboard.
async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied`);
    return true;
  } catch {
    say("The browser does not allow copying here", "error");
    return false;
  }
}

// Returns the shader of a model, or of OpenPBR by its formulas.
async function codeOf(entry, call) {
  const options = {name: stem(entry)};
  if (entry.spec !== "openpbr") return (await entry.material.shader(language, options, call)).code;
  const [{bytes}] = await entry.material.export(language, options, call);
  return new TextDecoder().decode(bytes);
}

function shaderGroup(entry) {
  const text = make("pre", {tabindex: 0, role: "region", "aria-label": "Shader", hidden: !textOpen});
  const fill = async () => {
    if (textOpen) text.textContent = await codeOf(entry);
  };
  const select = make("select", {"aria-label": "Language", onchange: () => {
    language = select.value;
    fill().catch(sayError);
  }}, ...Object.entries(languages).map(([value, title]) => make("option", {value}, title)));
  select.value = language;
  const toggle = make("button", {type: "button", "aria-expanded": String(textOpen), onclick: () => {
    textOpen = text.hidden;
    text.hidden = !textOpen;
    toggle.setAttribute("aria-expanded", String(textOpen));
    toggle.textContent = textOpen ? "Hide" : "Show";
    fill().catch(sayError);
  }}, textOpen ? "Hide" : "Show");
  const extension = {glsl: "glsl", glsl_es: "es.glsl", hlsl: "hlsl", slang: "slang", wgsl: "wgsl", msl: "metal", cpp: "h"};
  fill().catch(sayError);
  return make("div", {}, make("h3", {}, `Shader of ${entry.name}`),
    make("div", {class: "buttons"}, select, toggle,
      make("button", {type: "button", onclick: guarded(async (signal) => copy(await codeOf(entry, {signal}), "Shader"))}, "Copy"),
      make("button", {type: "button", "data-export": "shader", onclick: guarded(async (signal) => {
        saveFile(`${stem(entry)}.${extension[language]}`, await codeOf(entry, {signal}), "text/plain");
      })}, "Save")), text);
}

function linkGroup(entry) {
  const said = make("p", {class: "hint two-lines"}, "The address holds the whole material: nothing is uploaded.");
  const shown = make("input", {type: "text", id: "link-text", readonly: true, hidden: true, "aria-label": "Link", onfocus: () => shown.select()});
  return make("div", {}, make("h3", {}, "Link"), make("div", {class: "buttons"},
    make("button", {type: "button", id: "link", onclick: guarded(async (signal) => {
      const [{bytes}] = await filesOf(entry, "burnish", signal);
      const link = linkOf(stem(entry), bytes);
      find("#link").dataset.link = link;
      said.textContent = `${bytesText(bytes.length)} as ${link.length.toLocaleString("en")} characters${bytes.length > kLongLink ? "; some programs cut links this long" : ""}.`;
      if (await copy(link, "Link")) return;
      // The link is shown, to be copied by hand.
      [shown.value, shown.hidden] = [link, false];
      shown.focus();
      say("The browser does not allow copying here; the link is below its button");
    })}, "Copy link")), shown, said);
}

// Returns the chart as a file that stands alone.
function svgText(figure) {
  const copied = figure.cloneNode(true), [, , width, height] = copied.getAttribute("viewBox").split(" ");
  for (const [name, value] of Object.entries({xmlns: "http://www.w3.org/2000/svg", width, height, "font-family": "system-ui, sans-serif", "font-size": 11}))
    copied.setAttribute(name, value);
  const ground = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  for (const [name, value] of Object.entries({width, height, fill: css("--panel")})) ground.setAttribute(name, value);
  copied.prepend(ground);
  return new XMLSerializer().serializeToString(copied);
}

// Returns a picture that draw(pen) draws on the panel's ground.
function pngOf(width, height, draw) {
  const canvas = make("canvas", {width, height}), pen = canvas.getContext("2d");
  pen.fillStyle = css("--panel");
  pen.fillRect(0, 0, width, height);
  draw(pen);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}

// Returns the pictures over theta_h and theta_d side by side, each cell a square of pixels.
function halfDiffPng() {
  const shown = canvasesOf("#half-diff"), kCell = 4, kGap = 16, kText = 24, side = kCell * shown[0].width;
  return pngOf(shown.length * (side + kGap) - kGap, side + kText, (pen) => {
    [pen.imageSmoothingEnabled, pen.fillStyle, pen.font] = [false, css("--soft"), "13px system-ui, sans-serif"];
    shown.forEach((from, k) => {
      pen.drawImage(from, k * (side + kGap), 0, side, side);
      pen.fillText(from.nextElementSibling.textContent, k * (side + kGap), side + 17, side);
    });
  });
}

// Returns the lobe's picture as it is turned.
function lobePng() {
  const [shown] = canvasesOf("#lobe");
  return pngOf(shown.width, shown.height, (pen) => pen.drawImage(shown, 0, 0));
}

function canvasesOf(selector) {
  const found = [...document.querySelectorAll(`${selector} canvas`)];
  if (!found.length) throw new Error("The picture is not drawn yet");
  return found;
}

function pictureGroup() {
  const chart = (title, selector, name) => make("button", {type: "button", "data-export": name, onclick: guarded(async () => {
    saveFile(`${stem(state.shown)}-${name}.svg`, svgText(find(`${selector} svg`)), "image/svg+xml");
  })}, title);
  const drawn = (title, png, name, entry) => make("button", {type: "button", "data-export": name, onclick: guarded(async () => {
    saveFile(`${stem(entry)}-${name}.png`, await png());
  })}, title);
  return make("div", {}, make("h3", {}, "Pictures"), make("div", {class: "buttons"},
    make("button", {type: "button", "data-export": "png", onclick: guarded(async (signal) => {
      const blob = await picture(signal);
      if (blob) saveFile(`${stem(state.shown)}.png`, blob);
    })}, "View as PNG"), chart("Slice as SVG", "#slices", "slice"), chart("Albedo as SVG", "#albedo", "albedo"),
    drawn("θh, θd as PNG", halfDiffPng, "half-diff", state.shown), drawn("Lobe as PNG", lobePng, "lobe", state.beside ?? state.shown),
    referenceOf(state.shown).curve?.length ? chart("Bytes curve as SVG", "#bytes-curve", "curve") : ""));
}

function draw() {
  const place = find("#take"), model = modelShown();
  if (!state.shown) {
    place.replaceChildren(make("p", {class: "hint"}, "This panel exports shaders, textures and files of the open materials, pictures, and a link that holds a model."));
    return;
  }
  const surface = isSurface(model), files = surface ? surfaceFiles : modelFiles, apart = [state.shown, state.beside].filter((entry) => entry && !isSurface(entry));
  replaceKeepingFocus(place,
    model ? shaderGroup(model) : make("p", {class: "hint"}, state.shown.spec === "openpbr" ? "Fit a model for textures and a link." : "Fit first: a model has a shader, textures and a link."),
    model ? make("div", {}, make("h3", {}, surface ? "Surface" : "Model"), make("div", {class: "buttons"}, ...Object.entries(files).map(([kind, title]) => saveButton(model, kind, title)))) : "",
    model ? linkGroup(model) : "",
    ...apart.filter(({spec}) => spec === "openpbr").map((each) => make("div", {"data-openpbr": each.id}, shaderGroup(each), make("h3", {}, `OpenPBR of ${each.name}`),
      make("p", {class: "hint"}, "Exports the inputs that the sliders set; no fit is needed."),
      make("div", {class: "buttons"}, ...Object.entries(openPbrFiles).map(([kind, title]) => saveButton(each, kind, title))))),
    ...apart.map((each) =>
      make("div", {"data-of": each.id}, make("h3", {}, `${each.name} as`),
        make("div", {class: "buttons"}, ...Object.entries(anyFiles).filter(([kind]) => kind !== "exr" || !each.model).map(([kind, title]) => saveButton(each, kind, title))))),
    pictureGroup());
}

export function start() {
  draw();
  onChange((what) => what !== "judged" && draw());
}
