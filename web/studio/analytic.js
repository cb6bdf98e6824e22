// Analytic BRDFs with sliders, and a sample that resembles a goniometer's measurement.
import {find, lineOf, make, say} from "./dom.js";
import {open} from "./library.js";
import {openOne, renewer} from "./materials.js";
import {changed, state} from "./state.js";

const kCells = 40;  // cells of the sample, along theta_h and theta_d

// Parameters are [name, kind, value, least, most]. A "log" slider has even factors. Ranges are those of
// docs/guide/analytic.md.
const alpha = (name, value = 0.2) => [name, "log", value, 0.005, 1];
const color = (name, value) => [name, "color", value];
const exponent = (name, value) => [name, "log", value, 1, 10000];
const line = (name, value, least, most) => [name, "line", value, least, most];
const facets = [alpha("alpha_x"), alpha("alpha_y"), color("f0", [0.9, 0.62, 0.3]), color("kd", [0, 0, 0])];
const threads = [["alpha_x", "log", 0.1, 0.05, 1], ["alpha_y", "log", 0.5, 0.05, 1], line("cross", 0.15, 0, 1),
                 color("f0", [0.35, 0.1, 0.45]), color("kd", [0.08, 0.02, 0.1])];
const ward = [alpha("alpha_x", 0.15), alpha("alpha_y", 0.15), color("kd", [0.25, 0.05, 0.04]), color("ks", [0.2, 0.2, 0.2])];
const phong = (value, ks) => [color("kd", [0.05, 0.15, 0.3]), color("ks", [ks, ks, ks]), exponent("exponent", value)];
const share = (name, value) => line(name, value, 0, 1);
const index = (name, value) => line(name, value, 1, 5);
const openpbr = [
  share("base_weight", 1), color("base_color", [0.5, 0.04, 0.03]), share("base_metalness", 0), share("base_diffuse_roughness", 0),
  share("specular_weight", 1), color("specular_color", [1, 1, 1]), share("specular_roughness", 0.4), share("specular_roughness_anisotropy", 0),
  index("specular_ior", 1.5), share("coat_weight", 1), color("coat_color", [1, 1, 1]), share("coat_roughness", 0.1),
  share("coat_roughness_anisotropy", 0), index("coat_ior", 1.6), share("coat_darkening", 1), share("fuzz_weight", 0),
  color("fuzz_color", [1, 1, 1]), share("fuzz_roughness", 0.5), share("thin_film_weight", 0), line("thin_film_thickness", 0.5, 0, 5),
  index("thin_film_ior", 1.4), line("geometry_tangent", 0, 0, 180),
];
const models = {
  openpbr,
  ggx: facets,
  beckmann: facets,
  cook_torrance: [alpha("alpha"), color("f0", [0.5, 0.5, 0.5]), color("kd", [0, 0, 0])],
  ashikhmin_shirley: [["exponent_x", "log", 100, 1, 100000], ["exponent_y", "log", 100, 1, 100000], color("f0", [0.3, 0.3, 0.3]), color("kd", [0.1, 0.25, 0.2])],
  ward, ward_duer: ward, ward_bounded: ward,
  phong: phong(20, 1), phong_normalized: phong(20, 0.8), blinn_phong: phong(80, 1), blinn_phong_normalized: phong(80, 0.8),
  lambert: [color("kd", [0.6, 0.6, 0.6])],
  oren_nayar: [color("kd", [0.6, 0.4, 0.3]), line("sigma", 0.5, 0, 1.57)],
  satin: threads, ashikhmin_premoze_shirley: threads,
  poulin_fournier: [line("spacing", 2.5, 2, 20), line("height", 1, 0.001, 1), exponent("exponent", 50),
                    color("kd", [0.2, 0.2, 0.2]), color("ks", [0.8, 0.8, 0.8])],
  lafortune: [color("kd", [0.2, 0.2, 0.2]), line("cx", -0.9, -1.5, 1.5), line("cy", -0.9, -1.5, 1.5),
              line("cz", 0.9, -1.5, 1.5), ["exponent", "log", 20, 1, 1000], color("ks", [1, 1, 1])],
};

const digits = (x) => String(Number(x.toPrecision(4)));
const spec = (name, values) =>
  `${name}:${models[name].map(([p], k) => `${p}=${[values[k]].flat().map(digits).join("/")}`).join(",")}`;

// These convert linear colours to those of a colour field, and back.
const hexOf = (rgb) => `#${rgb.map((x) => Math.round(255 * x ** (1 / 2.2)).toString(16).padStart(2, "0")).join("")}`;
const rgbOf = (hex) => [1, 3, 5].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255) ** 2.2);

// Returns a slider for a parameter; told(value) is called at each change.
function field([name, kind, value, least, most], told) {
  const label = make("span", {}, name.replaceAll("_", " "));
  if (kind === "color") {
    const input = make("input", {type: "color", value: hexOf(value), oninput: () => told(rgbOf(input.value))});
    return make("label", {}, label, input, make("output"));
  }
  const at = (x) => (kind === "log" ? least * (most / least) ** x : least + (most - least) * x);
  const place = kind === "log" ? Math.log(value / least) / Math.log(most / least) : (value - least) / (most - least);
  const output = make("output", {}, digits(value));
  const input = make("input", {type: "range", min: 0, max: 1, step: 0.001, value: place, oninput: () => {
    output.textContent = Number(at(Number(input.value)).toPrecision(3));
    told(at(Number(input.value)));
  }});
  return make("label", {}, label, input, output);
}

// Adds an entry that its sliders change in place. Each change gives it another material.
async function openModel(name) {
  let values = models[name].map(([, , value]) => value), asked, last = values;
  const entry = await openOne(spec(name, values), name, {spec: name});
  if (!entry) return;
  const renew = renewer(entry, (signal) => open(spec(name, asked = values), {signal}), {
    done: () => (last = asked),
    undo: () => drawFields(last),
  });
  const drawFields = (from) => {
    values = from;
    entry.sliders = models[name].map(([parameter, kind, , ...ends], k) => field([parameter, kind, values[k], ...ends], (value) => {
      values = values.with(k, value);
      renew();
    }));
    changed("shown");
  };
  drawFields(values);
}

// Returns random numbers of a seed, uniform in [0, 1).
function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// Returns the bytes of a MERL file: red paint under varnish, a coloured base and a sharp coat, with 2 % of noise.
async function samplePaint() {
  const part = async (text) => {
    const material = await open(text), {data} = await material.volume({thetaH: kCells, thetaD: kCells, phiD: 4 * kCells});
    material.close();
    return data;
  };
  const base = await part("ggx:alpha_x=0.4,alpha_y=0.4,f0=0.3/0.03/0.02,kd=0.3/0.02/0.015");
  const coat = await part("ggx:alpha_x=0.12,alpha_y=0.12,f0=0.05");
  // The file has three planes of doubles: phi_d over half a circle is fastest, then theta_d, then theta_h.
  const cells = kCells * kCells * 2 * kCells, bytes = new DataView(new ArrayBuffer(12 + 24 * cells)), u = random(7);
  [kCells, kCells, 2 * kCells].forEach((size, k) => bytes.setInt32(4 * k, size, true));
  for (let at = 0; at < cells; ++at) {
    const j = at % (2 * kCells), l = Math.floor(at / (2 * kCells)) % kCells, i = Math.floor(at / (2 * kCells * kCells));
    const from = 3 * ((j * kCells + l) * kCells + i), noise = Math.exp(0.02 * Math.sqrt(-2 * Math.log(1 - u())) * Math.cos(2 * Math.PI * u()));
    for (let c = 0; c < 3; ++c)
      bytes.setFloat64(12 + 8 * (c * cells + at), ((base[from + c] + coat[from + c]) * noise * 1500) / [1, 1.15, 1.66][c], true);
  }
  return bytes.buffer;
}

export function drawSliders() {
  const place = find("#analytic"), sliders = state.shown?.sliders;
  place.hidden = !sliders;
  if (sliders?.[0].parentElement !== place) place.replaceChildren(...(sliders ?? []));
}

export function start() {
  const select = find("#start");
  select.append(make("option", {value: ""}, "an analytic model or a sample…"), make("option", {value: "sample"}, "sample: measured red paint"),
    make("optgroup", {label: "Analytic"}, ...Object.keys(models).map((name) => make("option", {value: name}, name.replaceAll("_", " ")))));
  select.addEventListener("change", async () => {
    const name = select.value;
    select.value = "";
    try {
      if (name === "sample") await openOne(await samplePaint(), "red-paint.binary");
      else if (name) await openModel(name);
    } catch (error) {
      say(lineOf(error), "error");
    }
  });
}
