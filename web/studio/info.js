// Shows `info --json` as a panel.
import {bytesText, find, make, number, pageWords, row, table} from "./dom.js";
import {onChange, state} from "./state.js";

const span = ([low, high]) => `${number(low, 3)}° to ${number(high, 3)}°`;

const kDrawn = {
  shader: () => "by the shader that is exported",
  whole: (db, what) => `from its own tables, ${number(db, 3)} dB from ${what}`,
  table: (db, what, computed) => {
    const table = `through a table, ${number(db, 3)} dB from ${what}`;
    if (!computed) return table;
    return `computed by the library${computed < 1 ? `, ${Math.round(100 * computed)} % of it` : ""}; while it moves, ${table}`;
  },
};

const channelsOf = ({channels}) => `${channels} channel${channels === 1 ? "" : "s"}`;

function surfaceFacts(info) {
  const maps = info.weights.map((map, k) => [`Weights ${k + 1}`, `${channelsOf(map)}, ${map.format}, up to ${number(map.scale, 3)}`]);
  return [["Format", "surface"], ["Texels", `${info.width} × ${info.height}`], ["Lobes", `${info.weights.length}, ${channelsOf(info)}`], ...maps,
          ["Normals", info.normals ? "a map" : "of the plane"], ["Tangents", info.tangents ? "a map" : "along u"],
          ["Albedo", `${number(info.albedo.mean, 3)} on average, at most ${number(info.albedo.largest, 3)}`], ["Size", bytesText(info.bytes)]];
}

function facts(info, {drawn, computed, material, spec}) {
  if (info.width) return surfaceFacts(info);
  const rows = [["Format", info.format]];
  // Sliders show the parameters of an analytic model.
  if (info.description) rows.push(["Description", spec ? info.description.split(`: ${spec}:`)[0] : info.description]);
  const waves = info.lambda_nm?.length ? `, ${number(info.lambda_nm[0])} to ${number(info.lambda_nm.at(-1))} nm` : "";
  rows.push(["Channels", `${info.channels}${waves}${info.illuminant ? `, under ${info.illuminant}` : ""}`]);
  rows.push(["Material", info.isotropic ? "isotropic" : "anisotropic"]);
  if (info.samples > 0) rows.push(["Samples", info.samples.toLocaleString("en")]);
  if (info.samples > 0) rows.push(["Holes", info.holes ? `${info.holes.toLocaleString("en")}, ${number((100 * info.holes) / info.samples, 3)} %` : "none"]);
  if (info.negatives > 0) rows.push(["Negatives", `${info.negatives.toLocaleString("en")}, down to ${number(info.most_negative, 3)}`]);
  rows.push(["θ to the light", span(info.theta_i_deg)], ["θ to the viewer", span(info.theta_o_deg)]);
  rows.push(["Reciprocity", info.reciprocity_error < 1e-9 ? "exact" : `${number(100 * info.reciprocity_error, 3)} % off on average`]);
  if (info.mirror_asymmetry !== undefined) rows.push(["Mirror asymmetry", `${number(100 * Math.expm1(info.mirror_asymmetry), 3)} %`]);
  const angles = info.nodes?.incident_angles ? `, ${info.nodes.incident_angles} angles of incidence` : "";
  if (info.nodes) rows.push(["Measured at", `${info.nodes.count.toLocaleString("en")} nodes${angles}`]);
  if (info.bytes) rows.push(["Size", bytesText(info.bytes)]);
  if (drawn) rows.push(["Drawn", kDrawn[drawn.how](drawn.decibels, material.measurement ? "what is measured" : "the function", computed)]);
  if (info.shader) rows.push(["Shader", `${info.shader.fetches} fetches, ${info.shader.operations} operations`]);
  return rows;
}

export const incidence = ({theta_i_deg, phi_i_deg}) => `${number(theta_i_deg, 3)}°${phi_i_deg > 0 ? `, ${number(phi_i_deg, 3)}°` : ""}`;

const kSomeUnknown = 1e-3, kAllUnknown = 0.999;  // shares of the hemisphere
function albedos({albedo}) {
  if (!albedo?.length) return null;
  const names = {1: ["grey"], 3: ["red", "green", "blue"]}[albedo[0].albedo.length] ?? ["1", "2", "3"];
  const unknown = albedo.some((at) => at.unknown_fraction > kSomeUnknown);
  return table("Albedo", ["at", ...names, ...(unknown ? ["unknown"] : [])], albedo.map((at) => {
    const known = at.albedo.slice(0, 3).map((x) => (at.unknown_fraction > kAllUnknown ? "–" : number(x, 3)));
    return row([incidence(at), ...known, ...(unknown ? [`${number(100 * at.unknown_fraction, 3)} %`] : [])]);
  }));
}

// Shows controls where a format leaves its reading open. The same controls stay, and keep the focus.
function drawReadings(controls = []) {
  const place = find("#readings");
  place.hidden = controls.length === 0;
  if (controls.length !== place.children.length || controls.some((control, k) => control !== place.children[k])) place.replaceChildren(...controls);
}

function draw() {
  // Each material gets a new element, since it stands below parts that other materials may have more of.
  const place = make("div", {id: "info"}), entry = state.shown;
  find("#info").replaceWith(place);
  drawReadings(entry?.readings);
  if (!entry) {
    place.replaceChildren(make("p", {class: "hint"}, "This panel shows format, conventions, holes, albedo and reciprocity of the open material."));
    return;
  }
  const {info} = entry;
  if (!info) {
    place.replaceChildren(make("p", {class: "hint"}, `Looking at ${entry.name}…`));
    return;
  }
  const notes = info.conventions?.filter((text) => !text.startsWith("notes of the fit")) ?? [];
  notes.push(...(info.warnings ?? []).map((text) => `Warning: ${pageWords(text)}`));
  if (info.left_out?.length) notes.push(`Left out: ${info.left_out.join(", ")}.`);
  place.replaceChildren(
    make("dl", {}, ...facts(info, entry).flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)])),
    albedos(info) ?? "", notes.length ? make("ul", {"aria-label": "Conventions"}, ...notes.map((text) => make("li", {}, text))) : "");
}

// On phones the panel has a fixed height and is scrolled, by keys too.
function scroll({matches}) {
  if (matches) find("#info-panel").tabIndex = 0;
  else find("#info-panel").removeAttribute("tabindex");
}

export function start() {
  const narrow = window.matchMedia("(max-width: 760px)");
  narrow.addEventListener("change", scroll);
  scroll(narrow);
  draw();
  onChange(draw);
}
