// node studio.mjs SITE BURNISH FOLDER [FIGURES]: the page in SITE (build/studio) in headless Chromium, beside the command
// line BURNISH. Files go into FOLDER, where burnish_input_files wrote its own; screenshots into FIGURES if it is given.
// Prints how fast it is and what it takes; asserted is only what a busy machine does not change.
// $HOSTILE_STEP: every how many-th damaged file is dropped, 1 for all.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import {createRequire} from "node:module";
import path from "node:path";
import zlib from "node:zlib";
import {chromium} from "playwright-core";

const [site, burnish, folder, figures] = process.argv.slice(2);
const kMaxBytes = 3 << 20;       // of the page, compressed
const kSame = 1e-6;               // relative, between the page's figures and the command line's
const kMaxShift = 0.002;        // of Chromium's layout shift while files are opened and fitted
const kExact = 60;               // dB, of what is drawn from a measurement's own tables
const kComputed = 1e-5;          // of the brightest light, between what is computed and what is drawn of RGL's own tables
const kMaxMemory = 512 << 20;    // of the process with page and workers while a file of MERL's size is fitted, bytes
const kDrawn = 12;               // damaged files that are no longer refused, of which the picture is waited for
const kPatience = 120_000;        // milliseconds; the renderer is software
const kHostileStep = Number(process.env.HOSTILE_STEP ?? 11);
const axe = fs.readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const run = (...args) => execFileSync(burnish, args, {stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 28}).toString();
const file = (name) => path.join(folder, name);
fs.mkdirSync(folder, {recursive: true});

// Server of the site, and what was asked of it.
const kTypes = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".wasm": "application/wasm"};
// From the second a page may share memory between workers.
const kIsolated = {"cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp"};
const answer = (headers) => (request, response) => {
  const asked = path.join(site, path.normalize(new URL(request.url, "http://x").pathname)), found = asked.endsWith("/") ? `${asked}index.html` : asked;
  if (!fs.existsSync(found)) return response.writeHead(404).end();
  response.writeHead(200, {"content-type": kTypes[path.extname(found)] ?? "application/octet-stream", ...headers}).end(fs.readFileSync(found));
};
const servers = [http.createServer(answer({})), http.createServer(answer(kIsolated))];
const [address, isolatedAddress] = await Promise.all(servers.map((each) => new Promise((done) =>
  each.listen(0, () => done(`http://localhost:${each.address().port}/`)))));

const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]});
const complaints = [], requests = [];
async function visit(link = address, options = {}) {
  const context = await browser.newContext({viewport: {width: 1440, height: 940}, acceptDownloads: true, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  page.on("console", (said) => {
    if (!["error", "warning"].includes(said.type()) || /GPU stall|GL Driver Message/.test(said.text())) return;
    // Chromium asks for the icon again where the address changes, offline too
    if (said.location().url === `${address}icon.svg` && /ERR_INTERNET_DISCONNECTED/.test(said.text())) return;
    complaints.push(`${said.text()} ${said.location().url}`);
  });
  page.on("pageerror", (error) => complaints.push(error.stack));
  page.on("request", (request) => requests.push(request.url()));
  await page.addInitScript(() => {
    // as on a machine with processors to spare; and in a browser that does not say how far a pointer moved
    Object.defineProperty(navigator, "hardwareConcurrency", {value: 4});
    Object.defineProperty(MouseEvent.prototype, "movementX", {value: 0});
    Object.defineProperty(MouseEvent.prototype, "movementY", {value: 0});
    window.textures = new Set();
    const {createTexture, deleteTexture} = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.createTexture = function () {
      const made = createTexture.call(this);
      window.textures.add(made);
      return made;
    };
    WebGL2RenderingContext.prototype.deleteTexture = function (gone) {
      window.textures.delete(gone);
      deleteTexture.call(this, gone);
    };
    window.shifted = 0;
    new PerformanceObserver((list) => list.getEntries().forEach((entry) => !entry.hadRecentInput && (window.shifted += entry.value)))
      .observe({type: "layout-shift", buffered: true});
  });
  await page.goto(link, {waitUntil: "networkidle"});
  await page.evaluate(async () => {
    const [{state, referenceOf}, {judgedOf}] = await Promise.all([import("./state.js"), import("./figures.js")]);
    window.studio = state;
    // beside what it is of, or else what is shown
    window.figuresOf = (entry) => judgedOf(entry.parent === null ? state.shown : referenceOf(entry), entry)?.figures;
  });
  return page;
}

const compared = (source) => JSON.parse(run("compare", "--json", "--count", "2000", source, file("a.burnish")))[0];
// What the page has open, and messages.
const opened = (page) => page.evaluate(() => window.studio.entries.map((entry) => ({name: entry.name, info: entry.info, parent: entry.parent, figures: window.figuresOf(entry)})));
const until = (page, count) => page.waitForFunction((n) => window.studio.entries.length === n && window.studio.entries.every((entry) => entry.info), count);
const message = (page) => page.evaluate(() => (document.querySelector("#message").hidden ? "" : document.querySelector("#message-text").textContent));
async function drop(page, names) {
  const files = names.map((name) => [path.basename(name), fs.readFileSync(file(name)).toString("base64")]);
  await page.evaluate((given) => {
    const transfer = new DataTransfer();
    for (const [name, data] of given) transfer.items.add(new File([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))], name));
    for (const type of ["dragenter", "dragover", "drop"]) window.dispatchEvent(new DragEvent(type, {dataTransfer: transfer, cancelable: true}));
  }, files);
}
async function save(page, selector, name) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  await download.saveAs(file(name));
  return file(name);
}
// Files of an archive, which Python opens, as bytes by their names.
function unpacked(archive) {
  const at = file("unpacked");
  fs.rmSync(at, {recursive: true, force: true});
  execFileSync("python3", ["-m", "zipfile", "-e", archive, at]);
  return Object.fromEntries(fs.readdirSync(at).sort().map((name) => [name, fs.readFileSync(path.join(at, name))]));
}
const settled = (page) => page.waitForFunction(() => document.documentElement.dataset.view === "settled");

// Numbers alike to kSame, at the same places; a path in a name is no difference.
const kNames = ["name", "model", "note"];
function same(found, expected, at) {
  if (typeof expected === "number") {
    assert.ok(Math.abs(found - expected) <= kSame * Math.max(Math.abs(expected), 1e-9), `${at}: expected ${expected}, found ${found}`);
  } else if (expected !== null && typeof expected === "object") {
    for (const key of Object.keys(expected).filter((name) => !kNames.includes(name))) same(found?.[key], expected[key], `${at}.${key}`);
  } else {
    assert.equal(found, expected, at);
  }
}
// The second entry's info and figures are those of a source of the command line, the first one's a.burnish.
async function sameAs(source, at) {
  const [, {info}] = await opened(page);
  same(info, JSON.parse(run("info", "--json", source)), at);
  const figures = await page.evaluate(() => window.studio.entries[1].material.compare(window.studio.entries[0].material, {count: 2000}));
  same(figures[0], compared(source), `compare ${at}`);
}
// Scattered samples in the formats that are read alone, their cosines above the threshold of figures.
function writeScattered() {
  const alta = ["#SAMPLE \"a\"", "#DIM 3 1", "#VS 1", "#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI", "#PARAM_OUT INV_STERADIAN"], cornell = ["# a", "# a", "3", "450 550 650"],
    fred = ["type bsdf_data", "format angles=rad bsdf=value scale=1"];
  for (const thetaI of [0.2, 0.5, 0.9]) {
    fred.push(`${thetaI} 0`);
    for (const thetaO of [0.1, 0.4, 0.7, 1])
      for (const phi of [0.3, 1.2, 2.1, 3]) {
        const cosine = Math.cos(thetaI) * Math.cos(thetaO) - Math.sin(thetaI) * Math.sin(thetaO) * Math.cos(phi), f = 0.05 + 0.4 * Math.max(cosine, 0) ** 9;
        alta.push([thetaI, thetaO * Math.cos(phi), thetaO * Math.sin(phi), f, 0.01].join(" "));
        cornell.push([thetaI, 0, thetaO, phi, f, 0.8 * f, 0.5 * f].join(" "));
        fred.push([thetaO, phi + Math.PI, f].join(" "));
      }
  }
  fs.writeFileSync(file("a.fred"), `${fred.join("\n")}\n`);
  fs.writeFileSync(file("a.alta"), `${alta.join("\n")}\n`);
  fs.writeFileSync(file("a.cornell"), `${cornell.join("\n")}\n`);
}
// Nothing moved since the last time that this was asked.
async function steady(page, what) {
  const shifted = await page.evaluate(() => [window.shifted, (window.shifted = 0)][0]);
  assert.ok(shifted <= kMaxShift, `${what}: layout shifted by ${shifted}`);
}
async function accessible(page, what) {
  await page.evaluate(axe);
  const violations = await page.evaluate(async () => (await window.axe.run()).violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" ").slice(0, 400)}`));
  assert.deepEqual(violations, [], `${what}: axe`);
}

// The page's size.
const compressed = (folder) => fs.readdirSync(folder, {withFileTypes: true}).reduce((sum, each) => {
  const name = path.join(folder, each.name);
  return sum + (each.isDirectory() ? compressed(name) : zlib.gzipSync(fs.readFileSync(name), {level: 9}).length);
}, 0);
const size = compressed(site);
assert.ok(size <= kMaxBytes, `expected at most ${kMaxBytes} bytes compressed, found ${size}`);

// What the page lets itself do: nothing but its own files, and nothing within its text.
const policy = fs.readFileSync(path.join(site, "index.html"), "utf8").match(/http-equiv="Content-Security-Policy" content="([^"]+)"/)[1];
assert.match(policy, /^default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; style-src 'self';/);
assert.doesNotMatch(policy, /'unsafe-|\*|https?:|data:/);

// A file of every format that is read, and of both kinds of baselines.
const spec = "ggx:alpha_x=0.25,alpha_y=0.25,f0=0.9/0.6/0.3,kd=0.05";
for (const [name, ...more] of [["a.binary", "--to", "merl", "--cells", "20"], ["a.bsdf", "--to", "rgl"], ["a.mbsdf", "--to", "mbsdf"], ["z.bsdf", "--to", "zemax"],
                               ["a.astm", "--to", "astm", "--count", "2000"], ["a.csv", "--to", "csv", "--count", "2000"],
                               ["a.bin", "--to", "utia"], ["a.xompt", "--count", "2000"]])
  if (!fs.existsSync(file(name))) run("convert", spec, file(name), ...more);
// its few cubes alike: on which side of a step a direction is, its last bit says
run("convert", "lambert:kd=0.4", file("tree.xml"), "--to", "tensortree");
run("fit", spec, "--model", "pqp", "--samples", "20000", "-o", file("a.burnish"));
run("convert", file("a.burnish"), file("a.exr"));
run("fit", spec, "--method", "dgf", "--samples", "5000", "-o", file("dgf.json"));
writeScattered();
const seeds = fs.readdirSync(folder).filter((name) => name.startsWith("seed.") && !["seed.book", "seed.surface"].includes(name));
const kFormats = {"MERL": "a.binary", "UTIA": "a.bin", "RGL": "a.bsdf", "MBSDF": "a.mbsdf", "Zemax": "z.bsdf", "tensor tree": "tree.xml", "Klems": "seed.klems",
                  "Speos": "seed.speos", "OpenMATERIAL 3D": "a.xompt", "ALTA": "a.alta", "ASTM E1392": "a.astm", "CSV": "a.csv", "FRED": "a.fred", "Cornell": "a.cornell",
                  "model, OpenEXR": "a.exr", "model, compact": "a.burnish", "baseline": "seed.baseline", "network weights": "seed.neural"};
const kMoreFormats = ["book of a library", "surface", "Neural Processes codes"];  // tried apart
const listed = run("help", "formats").split("\n").filter((line) => / (both|read) /.test(line)).map((line) => line.split(/ {2,}/)[0]);
for (const title of [...Object.keys(kFormats), ...kMoreFormats]) assert.ok(listed.includes(title), `expected ${title} among the formats`);
// those that are not named here have a seed of their first word's name
const fileOf = (title) => kFormats[title] ?? `seed.${title.split(/[ ,]/)[0].toLowerCase()}`;
const formats = [...listed.filter((title) => !kMoreFormats.includes(title)).map(fileOf), "dgf.json"];
for (const name of formats) assert.ok(fs.existsSync(file(name)), `expected a file ${name} to try`);
fs.writeFileSync(file("garbage.bin"), "nothing of the kind <img src=x onerror=alert(1)>");
fs.writeFileSync(file("cut.bsdf"), fs.readFileSync(file("a.bsdf")).subarray(0, 3000));
fs.writeFileSync(file("huge.binary"), Buffer.from([255, 255, 255, 127, 255, 255, 255, 127, 255, 255, 255, 127, 0, 0]));
fs.writeFileSync(file("empty.csv"), "");

const page = await visit();
requests.length = 0;
await steady(page, "empty page");
await accessible(page, "empty page");
assert.equal(await page.evaluate(() => {
  const text = document.createElement("script");
  text.textContent = "window.broken = true";
  document.head.append(text);
  return window.broken;
}), undefined, "a script within the page's text runs");
complaints.splice(0, complaints.length, ...complaints.filter((text) => !/Content Security Policy/.test(text)));

// Unknown values are gaps in lines.
assert.equal(await page.evaluate(async () => {
  const {linePath} = await import("./chart.js");
  return linePath([[0, 0], [1, 1], [2, NaN], [3, 3], [NaN, 4], [5, 5], [6, 6]], {color: "red"}).getAttribute("d");
}), "M0.00,0.00L1.00,1.00M3.00,3.00h0M5.00,5.00L6.00,6.00");

// What is dropped while other files are opened comes after them.
await drop(page, ["a.binary", "a.mbsdf"]);
await drop(page, ["a.csv"]);
await until(page, 3);
assert.deepEqual((await opened(page)).map(({name}) => name), ["a.binary", "a.mbsdf", "a.csv"]);
await page.click("#list .close >> nth=0");
await page.click("#list .close >> nth=0");

// What a format leaves open is chosen; what a file does not have is said, and the choice goes back.
const chooses = async (name, how) => {
  const control = page.locator(`#readings [data-reading=${name}]`);
  if (how === true) await control.check();
  else await control.selectOption(how);
};
await chooses("hasCosine", true);
await page.waitForFunction((most) => Math.abs(window.studio.entries[0].info.albedo.at(-1).albedo[0] - most) < 1e-6 * most,
                           JSON.parse(run("info", "--json", "--has-cosine", file("a.csv"))).albedo.at(-1).albedo[0]);
await page.click("#list .close >> nth=0");
await drop(page, ["a.cornell"]);
await until(page, 1);
for (const light of ["D50", "A"]) {
  await chooses("illuminant", light);
  await page.waitForFunction((name) => window.studio.entries[0].info.illuminant === name, light);
  same((await opened(page))[0].info, JSON.parse(run("info", "--json", "--illuminant", light, file("a.cornell"))), light);
}
await page.click("#list .close >> nth=0");
await drop(page, ["seed.klems"]);
await until(page, 1);
await page.locator("#readings [data-reading=back]").click();
await page.waitForFunction(() => /Reflection Back/.test(document.querySelector("#message-text").textContent));
assert.equal(await page.isChecked("#readings [data-reading=back]"), false);
await page.click("#message-close");
await page.click("#list .close >> nth=0");

// Whatever is closed while it is changed leaves nothing open: the worker ends, and textures are given back.
const ended = () => page.waitForFunction(async () => (await import("./package/index.js")).memory() === 0);
await ended();
await page.selectOption("#start", "ggx");
await until(page, 1);
await page.waitForFunction(() => window.studio.entries[0].seen);
const before = await page.evaluate(() => window.textures.size);
await page.evaluate(() => {
  for (const at of [0.2, 0.4, 0.6]) {
    const slider = document.querySelector("#analytic input[type=range]");
    slider.value = at;
    slider.dispatchEvent(new Event("input"));
  }
  document.querySelector("#list .close").click();
});
await ended();
for (const edits of [1, 2]) {
  await drop(page, ["a.burnish"]);
  await until(page, 1);
  await page.focus("#edit input[data-edit=roughness]");
  for (let k = 0; k < edits; ++k) await page.keyboard.press("ArrowRight");
  if (edits === 1) await page.waitForFunction(() => window.studio.entries[0].material !== window.studio.entries[0].original);
  await page.click("#list .close");
  await ended();
}
await page.selectOption("#start", "ggx");
await until(page, 1);
await page.waitForFunction(() => window.studio.entries[0].seen);
await page.waitForFunction((most) => window.textures.size <= most, before);
await page.click("#list .close");
await until(page, 0);
await ended();
await steady(page, "what is chosen and closed");

// Rings of the polar plot are named in short, over no spoke and no other name, however large the values.
fs.writeFileSync(file("huge.csv"), ["theta_i,phi_i,theta_o,phi_o,value", ...[10, 30, 50, 70].flatMap((i) => [5, 25, 45, 65, 85].flatMap((o) =>
  [0, 180].map((phi) => `${i},0,${o},${phi},${10 ** (8 - o / 20)}`)))].join("\n"));
await drop(page, ["huge.csv"]);
await until(page, 1);
for (const log of [true, false]) {
  await page.setChecked("#log", log);
  await page.waitForFunction((count) => {
    const rings = [...document.querySelectorAll("#slices [data-ring]")];
    return rings.length >= 2 && (count ? rings : []).every((ring) => /^10/.test(ring.textContent)) && rings.at(-1).dataset.ring > 1e6;
  }, log);
  const {names, clear} = await page.evaluate(() => {
    const rings = [...document.querySelectorAll("#slices [data-ring]")], boxes = rings.map((ring) => ring.getBBox());
    const spokes = [...document.querySelectorAll("#slices path")].filter((path) => /^M[^A-Za]*L[^L]*$/.test(path.getAttribute("d")));
    const inside = ({x, y}, box) => x > box.x && x < box.x + box.width && y > box.y && y < box.y + box.height;
    const crossed = (box) => spokes.some((spoke) => Array.from({length: 400}, (_, k) => spoke.getPointAtLength(k / 399 * spoke.getTotalLength())).some((at) => inside(at, box)));
    const apart = (a, b) => a.y + a.height <= b.y || b.y + b.height <= a.y;
    return {names: rings.map((ring) => ring.textContent), clear: spokes.length >= 7 && boxes.every((box, k) => !crossed(box) && boxes.every((other, l) => k === l || apart(box, other)))};
  });
  assert.ok(clear && names.every((name) => name.length <= 7), `${names}`);
}
await page.click("#log");
await page.click("#list .close");
await until(page, 0);

// Every format at once: what the panel says is what `info --json` says.
await drop(page, formats);
await until(page, formats.length);
for (const {name, info} of await opened(page)) same(info, JSON.parse(run("info", "--json", file(name))), name);
assert.match(await page.textContent("#info"), /isotropic/);
assert.ok(await page.evaluate(() => {
  const list = document.querySelector("#list"), row = [...list.querySelectorAll("[data-shown]")].at(-1).getBoundingClientRect(), {top, bottom} = list.getBoundingClientRect();
  return list.scrollTop > 0 && row.top >= top - 1 && row.bottom <= bottom + 1;
}), "what is shown is in sight in the list");

// Figures are those of `compare --json`, for a source of every format.
const figuresOf = await page.evaluate(async () => {
  const {entries} = window.studio, model = entries.find(({name}) => name === "a.burnish").material, found = {};
  for (const {name, material} of entries) [found[name]] = await material.compare(model, {count: 2000});
  return found;
});
for (const name of formats) same(figuresOf[name], compared(file(name)), `compare ${name}`);

// MERL's and RGL's tables are drawn as they are interpolated.
await page.waitForFunction(() => window.studio.entries.filter(({drawn}) => drawn?.how === "whole").length >= 2);
for (const {name, drawn} of await page.evaluate(() => window.studio.entries.map(({name, drawn}) => ({name, drawn}))))
  if (["a.binary", "a.bsdf"].includes(name)) assert.ok(drawn.how === "whole" && drawn.decibels > kExact, `${name}: ${JSON.stringify(drawn)}`);

// What is drawn through a table is computed where the view rests. RGL's without their own tables become what these draw.
const computed = await page.evaluate(computedApart, fs.readFileSync(file("a.bsdf")).toString("base64"));
assert.ok(computed.computed < kComputed && computed.table > 100 * kComputed, JSON.stringify(computed));

// Garbage: one clear line each, and the page works on.
for (const name of ["garbage.bin", "cut.bsdf", "huge.binary", "empty.csv"]) {
  await drop(page, [name]);
  await page.waitForFunction((n) => document.querySelector("#message").dataset.kind === "error" && document.querySelector("#message-text").textContent.includes(n), name);
  assert.ok(!(await message(page)).includes("\n"));
}
assert.equal((await opened(page)).length, formats.length);
for (let k = 0; k < formats.length; ++k) await page.click("#list .close >> nth=0");
await until(page, 0);


await steady(page, "formats");

// Damaged files, as tests/hostile_test.cpp makes them: what is refused is refused in one line, and again where it is
// dropped, many at once; the library never stops, and its memory does not grow.
const textOf = (name) => fs.readFileSync(file(name)).toString("base64");
const hostile = await page.evaluate(damage, {seeds: seeds.map(textOf), step: kHostileStep, whole: textOf("a.bin")});
assert.deepEqual(hostile.unclear, []);
assert.ok(hostile.refused > 30000 / kHostileStep / 3, `${hostile.refused} refused`);
for (let done = 0; done < hostile.refused; done += 200) {
  const count = Math.min(200, hostile.refused - done), said = await page.evaluate(dropDamaged, {done, count});
  assert.ok(/expected/.test(said) && !said.includes("\n") && (count === 1 || said.includes(`(and ${count - 1} more of ${count} files could not be opened: `)), said);
}
assert.equal((await opened(page)).length, 0);
await page.click("#message-close");
for (let k = 0; k < Math.min(hostile.accepted, kDrawn); ++k) {
  await page.evaluate(dropAccepted, Math.floor((k * (hostile.accepted - 1)) / (kDrawn - 1)));
  await until(page, 1);
  await page.waitForFunction(() => window.studio.entries[0].seen);
  assert.equal(await message(page), "");
  await page.click("#list .close");
}

// Memory of a file of MERL's size is given back; how long until it is seen.
if (!fs.existsSync(file("whole.binary"))) run("convert", spec, file("whole.binary"), "--to", "merl");
await drop(page, ["a.mbsdf"]);
await until(page, 1);
const times = [], held = [];
for (let k = 0; k < 3; ++k) {
  await drop(page, ["whole.binary"]);
  times.push(await page.evaluate(async () => {
    const begin = performance.now(), wait = async (is) => { while (!is()) await new Promise((next) => setTimeout(next, 5)); };
    const entry = () => window.studio.entries.find(({name}) => name === "whole.binary");
    await wait(() => entry());
    const parsed = performance.now();
    await wait(() => entry().seen);
    return [parsed - begin, performance.now() - parsed];
  }));
  await until(page, 2);
  await page.click("#list .close >> nth=1");
  await until(page, 1);
  held.push(await page.evaluate(async () => (await import("./package/index.js")).memory()));
}
assert.ok(held[2] < 1.1 * held[0], `${held} bytes held`);
await page.click("#list .close >> nth=0");
await page.waitForFunction(async () => (await import("./package/index.js")).memory() === 0);

await steady(page, "damaged and large files");

// Of a book one is opened, and others are chosen.
await drop(page, ["a.burnish"]);
await until(page, 1);
await drop(page, ["seed.book"]);
await until(page, 2);
const names = await page.evaluate(() => window.studio.entries[1].material.entries);
await sameAs(`book:${file("seed.book")}#${names[0]}`, "book");
await page.selectOption("#analytic select", names[1]);
await page.waitForFunction((name) => window.studio.entries[1].name.endsWith(name), `#${names[1]}`);
await page.waitForFunction(() => window.studio.entries[1].info);
await sameAs(`book:${file("seed.book")}#${names[1]}`, "book");
await page.click("#list .close >> nth=1");

// Codes of Neural Processes with their decoder.
await drop(page, ["np/codes.csv", "np/decoder.f32"]);
await until(page, 2);
await sameAs(`np:${file("np")}#seed`, "Neural Processes");
for (let k = 0; k < 2; ++k) await page.click("#list .close >> nth=0");
await until(page, 0);

// A surface: what `info --json` says, drawn as its places are, and the module that the command line writes.
await drop(page, ["flat.burnish"]);
await until(page, 1);
same((await opened(page))[0].info, JSON.parse(run("info", "--json", file("flat.burnish"))), "surface");
assert.equal(await page.getAttribute("#shape [data-value=plane]", "aria-checked"), "true");
const apart = await page.evaluate(drawnApart, true);
assert.ok(apart < 5e-3, `a surface is drawn ${apart} from what it is`);
run("export", file("flat.burnish"), "--to", "three", "-o", file("surface"));
assert.equal(unpacked(await save(page, "[data-export=three]", "flat.three.zip"))["flat.three.js"].toString(), fs.readFileSync(file("surface/flat.three.js"), "utf8"));
run("export", file("flat.burnish"), "--to", "gltf", "-o", file("surface"));
const taken = JSON.parse(unpacked(await save(page, "[data-export=gltf]", "flat.gltf.zip"))["flat.json"]), written = JSON.parse(fs.readFileSync(file("surface/flat.json")));
assert.ok(Math.abs(taken.gltf_material.psnr - written.gltf_material.psnr) < 0.01, "a surface's nearest materials");
await accessible(page, "surface");
await page.click("#list .close >> nth=0");
await until(page, 0);
await page.click("#shape [data-value=sphere]");

// A mirror-like model, whose texels browsers would have to pack, is drawn as it is.
run("fit", "ggx:alpha_x=0.03,alpha_y=0.03,f0=0.9/0.2/0.02", "--budget", "2700", "--fetches", "2", "--format", "rgb9e5", "-o", file("mirror.burnish"));
await drop(page, ["mirror.burnish"]);
await until(page, 1);
const mirrored = await page.evaluate(drawnApart, false);
assert.ok(mirrored < 5e-3, `a mirror-like model is drawn ${mirrored} from what it is`);
await page.click("#list .close >> nth=0");
await until(page, 0);

// Light from pictures, in every compression that is read. Sizes that lie and those that are too large are said.
assert.deepEqual(await page.evaluate(hdrApart), []);
const wide = (name, width, data) => {
  const attribute = (called, type, bytes) => [Buffer.from(`${called}\0${type}\0`), words(bytes.length), bytes];
  const words = (...list) => Buffer.from(new Int32Array(list).buffer), channels = ["B", "G", "R"].map((c) => Buffer.concat([Buffer.from(`${c}\0`), words(1, 0, 1, 1)]));
  const header = [words(20000630, 2), ...attribute("channels", "chlist", Buffer.concat([...channels, Buffer.from([0])])), ...attribute("compression", "compression", Buffer.from([data ? 0 : 3])),
                  ...attribute("dataWindow", "box2i", words(0, 0, width - 1, data ? 0 : 8191)), Buffer.from([0])];
  const at = Buffer.concat(header).length + 8;
  fs.writeFileSync(file(name), Buffer.concat([...header, words(at, 0), ...(data ? [words(0, 6 * width), Buffer.alloc(6 * width)] : [Buffer.alloc(9000)])]));
};
wide("wide.exr", 20000, true);
wide("lie.exr", 8192, false);
fs.writeFileSync(file("lie.hdr"), "#?RADIANCE\n\n-Y 8192 +X 8192\n0000");
for (const [name, said] of [["wide.exr", "pixels, found 20000 x 1"], ["lie.exr", "the bytes of 8192 x 8192 pixels"], ["lie.hdr", "4 bytes at byte"]]) {
  await drop(page, [name]);
  await page.waitForFunction(([name, said]) => ((text) => text.startsWith(name) && text.includes(said))(document.querySelector("#message-text").textContent), [name, said]);
}
for (const kind of ["none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab", "tiles", "mips", "rips"]) {
  await drop(page, [`light-${kind}.exr`]);
  await page.waitForFunction((name) => document.querySelector("#message-text").textContent === `${name} lights the object`, `light-${kind}.exr`);
  assert.equal(await page.inputValue("#around"), "picture");
  const [given, read] = ["light", "read"].map((name) => fs.readFileSync(file(`${name}-${kind}.exr`)).toString("base64"));
  // cosines are summed in another order than OpenEXR's, so a half may be the next one
  if (/dwa/.test(kind)) assert.ok((await page.evaluate(lightFar, [given, read])) < 2e-3, kind);
  else assert.equal(await page.evaluate(lightApart, [given, read]), 0, kind);
  if (!/b44|rips|dwa/.test(kind)) assert.ok((await page.evaluate(lightOff, given)) < 1e-3, kind);
}
await page.selectOption("#around", "studio");

await steady(page, "books, surfaces and pictures");

// A model and a measurement stand side by side, whichever was dropped first, with the figures of the command line.
const [beside] = JSON.parse(run("compare", "--json", file("a.binary"), file("a.burnish")));
for (const names of [["a.binary", "a.burnish"], ["a.burnish", "a.binary"]]) {
  for (const [k, name] of names.entries()) {
    await drop(page, [name]);
    await until(page, k + 1);
  }
  assert.deepEqual(await page.evaluate(() => [window.studio.shown, window.studio.beside].map(({name}) => name)), ["a.binary", "a.burnish"]);
  assert.equal(await page.getAttribute("#shown [data-value=split]", "aria-checked"), "true");
  await page.waitForFunction(() => window.figuresOf(window.studio.beside));
  same(await page.evaluate(() => window.figuresOf(window.studio.beside)), beside, `compare ${names}`);
  assert.equal(Number(await page.getAttribute("#figures tbody tr[data-shown] td:nth-child(2) span", "title")), (await page.evaluate(() => window.figuresOf(window.studio.beside))).psnr);
  // either is there without the other
  await page.click(`#list .close[aria-label="Close ${names[0]}"]`);
  assert.deepEqual((await opened(page)).map(({name}) => name), [names[1]]);
  await page.click("#list .close");
  await until(page, 0);
}

// OpenPBR as its sliders have it is taken away without a fit, and is what the command line writes of the same inputs.
await page.selectOption("#start", "openpbr");
await until(page, 1);
const [{info: {name: sliders}}] = await opened(page);
const shaderEndings = {glsl: "glsl", glsl_es: "es.glsl", hlsl: "hlsl", slang: "slang", wgsl: "wgsl", msl: "metal", cpp: "h"};
run("export", sliders, "--to", ["materialx", "usda", "three", "babylon", "html", ...Object.keys(shaderEndings)].join(","), "--name", "openpbr", "-o", file("sliders"));
for (const [kind, name] of [["materialx", "openpbr.mtlx"], ["usda", "openpbr.usda"], ["three", "openpbr.three.js"], ["babylon", "openpbr.babylon.js"], ["html", "openpbr.html"]])
  assert.equal(fs.readFileSync(await save(page, `[data-openpbr] [data-export=${kind}]`, name), "utf8"), fs.readFileSync(file(`sliders/${name}`), "utf8"));
for (const [language, ending] of Object.entries(shaderEndings)) {
  await page.selectOption("[data-openpbr] select", language);
  const name = `openpbr.${ending}`, text = fs.readFileSync(await save(page, "[data-openpbr] [data-export=shader]", name), "utf8");
  assert.match(text, /burnish_openpbr\(/);
  assert.equal(text, fs.readFileSync(file(`sliders/${name}`), "utf8"));
}
await page.click("[data-openpbr] [aria-expanded]");
await page.waitForFunction(() => document.querySelector("[data-openpbr] pre").textContent.includes("burnish_openpbr"));
await page.click("[data-openpbr] [aria-expanded]");
await page.selectOption("[data-openpbr] select", "glsl_es");
assert.ok(fs.statSync(await save(page, "[data-openpbr] [data-export=gltf]", "openpbr.glb")).size > 100);
await page.click("#list .close");
await until(page, 0);

// The difference of two materials is shown times a factor.
for (const [k, name] of ["a.binary", "a.burnish"].entries()) {
  await drop(page, [name]);
  await until(page, k + 1);
}
await page.click("#shown [data-value=error]");
const timesFactor = async (factor) => {
  await page.selectOption("#error-factor", factor);
  await settled(page);
  return [await page.textContent("#error-most"), (await page.locator("#view").screenshot()).toString("base64")];
};
const [[most1, times1], [most50, times50]] = [await timesFactor("1"), await timesFactor("50")];
assert.deepEqual([most1, most50], ["100 %", "2 %"]);
assert.notEqual(times1, times50);
for (const count of [1, 0]) {
  await page.click("#list .close");
  await until(page, count);
}

// The page speaks of itself, not of the command line.
fs.writeFileSync(file("nothing.txt"), "no measurement");
await drop(page, ["nothing.txt"]);
await page.waitForFunction(() => document.querySelector("#message-text").textContent.includes("nothing.txt"));
assert.doesNotMatch(await message(page), /`burnish|--[a-z]/);
await page.click("#message-close");

// Fit: figures equal those of the command line for the saved model.
await drop(page, ["a.binary"]);
await until(page, 1);
await settled(page);
// what the fields show is what a fit is asked for, of the default too
assert.deepEqual(await page.evaluate(async () => {
  const {material} = window.studio.entries[0], fit = material.fit;
  let asked;
  material.fit = async (options) => {
    asked = options;
    throw new Error("asked");
  };
  document.querySelector("#presets [data-value=default]").click();
  document.querySelector("#fit-start").click();
  while (!asked || !document.querySelector("#fitting").hidden) await new Promise((next) => setTimeout(next, 5));
  material.fit = fit;
  return [asked.budget, asked.fetches, document.querySelector("#fetches").value];
}), ["16k", 2, "2"]);
await page.fill("#budget", "2700");
await page.fill("#fetches", "2");
await page.click("#fit-start");
await until(page, 2);
assert.equal(await page.locator("#figures thead abbr[title]").count(), await page.locator("#figures details dt").count());
const [, model] = await opened(page);
const saved = await save(page, "[data-export=burnish]", "fitted.burnish");
const [expected] = JSON.parse(run("compare", "--json", file("a.binary"), saved));
same(model.figures, expected, "compare");
const mean = (values) => values.reduce((sum, x) => sum + x, 0) / values.length, of = ({relative, rms_log, log_cos, rms}) => [relative, rms_log, log_cos, rms];
const [albedoRows, nodeRows] = await page.evaluate(() => [...document.querySelectorAll("#compared table")].map((table) =>
  [...table.tBodies[0].rows].map((row) => [...row.querySelectorAll("[title]:not(.name)")].map(({title}) => Number(title)))));
same(albedoRows, expected.albedo.map(({reference, model}) => [mean(reference), mean(model)]), "albedo in the panel");
same(nodeRows[1], of(expected.nodes), "nodes in the panel");
same(nodeRows[0], of(expected.nodes.itself), "the reference's own nodes in the panel");
assert.match(await page.textContent("#compared"), new RegExp(`At ${model.figures.nodes.count.toLocaleString("en")} measured nodes`));
run("fit", file("a.binary"), "--budget", "2700", "--fetches", "2", "-o", file("native.burnish"));
const [native] = JSON.parse(run("compare", "--json", file("a.binary"), file("native.burnish")));
assert.ok(Math.abs(native.psnr - expected.psnr) < 0.05, `fitted natively ${native.psnr} dB, in the page ${expected.psnr} dB`);
await accessible(page, "dark or light");

// A fit that is stopped leaves nothing, and the next one runs.
await page.fill("#budget", "64K");
await page.click("#fit-start");
await page.waitForSelector("#fit-stop", {state: "visible"});
await page.click("#fit-stop");
await page.waitForSelector("#fitting", {state: "hidden"});
assert.equal((await opened(page)).length, 2);

// The curve ends with the first fit that fails, and so do others; whole it is taken away.
const calls = await page.evaluate(async () => {
  const {material} = window.studio.entries[0], fit = material.fit.bind(material), signals = [];
  let fails = true;
  window.fitsAgain = () => (fails = false);
  material.fit = async ({budget}, call) => {
    signals.push(call.signal);
    if (fails && budget === 1400) throw new Error("no fit of 1400 bytes");
    return fit(fails ? {budget: 65536} : {model: "pqp", samples: 5000, seed: budget}, call);
  };
  document.querySelector("#curve-start").click();
  while (!document.querySelector("#fitting").hidden) await new Promise((next) => setTimeout(next, 5));
  return {count: signals.length, left: signals.filter(({aborted}) => !aborted).length, points: window.studio.entries[0].curve.length};
});
assert.deepEqual(calls, {count: 3, left: 0, points: 0});
assert.equal(await message(page), "no fit of 1400 bytes");
await page.evaluate(() => window.fitsAgain());
await page.click("#results [data-value=curve]");
await page.click("#curve-start");
await page.waitForFunction(() => window.studio.entries[0].curve.length === 7 && document.querySelector("[data-export=curve]"));
assert.match(fs.readFileSync(await save(page, "[data-export=curve]", "curve.svg"), "utf8"), /<svg[^]*PSNR/);
await page.click("#results [data-value=figures]");

// What is taken away is there; shaders say what they are.
for (const [kind, name] of [["ktx2", "fitted.ktx2"], ["three", "fitted.three.js"], ["gltf", "fitted.gltf.zip"], ["materialx", "fitted.materialx.zip"],
                            ["usda", "fitted.usda.zip"], ["babylon", "fitted.babylon.zip"], ["mdl", "fitted.mdl.zip"], ["merl", "out.binary"], ["csv", "out.csv"], ["png", "view.png"], ["slice", "slice.svg"],
                            ["half-diff", "half-diff.png"]])
  assert.ok(fs.statSync(await save(page, `[data-export=${kind}]`, name)).size > 100, kind);
// several files are an archive: textures of the formats and sizes that the command line writes, which compresses them too
run("export", saved, "--to", "ktx2", "-o", file("ktx2"), "--name", "fitted");
const heads = (files) => files.map((bytes) => bytes.subarray(0, 44).toString("hex"));
assert.deepEqual(heads(Object.entries(unpacked(file("fitted.ktx2"))).filter(([name]) => name.endsWith(".ktx2")).map(([, bytes]) => bytes)),
                 heads(["tables", "volumes"].map((kind) => fs.readFileSync(file(`ktx2/fitted.${kind}.ktx2`)))));
// the lobe's pixels, on the panel's ground
const lobeApart = await page.evaluate(async (text) => {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0)), saved = await createImageBitmap(new Blob([bytes])), lobe = document.querySelector("#lobe canvas");
  const pixelsOf = (from, ground) => {
    const canvas = new OffscreenCanvas(lobe.width, lobe.height), pen = canvas.getContext("2d");
    pen.fillStyle = ground;
    pen.fillRect(0, 0, lobe.width, lobe.height);
    pen.drawImage(from, 0, 0);
    return pen.getImageData(0, 0, lobe.width, lobe.height).data;
  };
  const ground = getComputedStyle(document.querySelector("#take-panel")).backgroundColor, [one, other] = [pixelsOf(saved, "red"), pixelsOf(lobe, ground)];
  const differ = one.reduce((most, x, i) => Math.max(most, Math.abs(x - other[i])), 0), plain = pixelsOf(new OffscreenCanvas(1, 1), ground);
  return {size: [saved.width - lobe.width, saved.height - lobe.height], differ, drawn: one.some((x, i) => x !== plain[i])};
}, fs.readFileSync(await save(page, "[data-export=lobe]", "lobe.png")).toString("base64"));
assert.deepEqual(lobeApart, {size: [0, 0], differ: 0, drawn: true});
// what was measured, and the fit of it
for (const entry of await page.evaluate(() => window.studio.entries.slice(0, 2).map(({id}) => id)))
  assert.ok(fs.statSync(await save(page, `[data-of="${entry}"] [data-export=merl]`, `${entry}.binary`)).size > 1000);
for (const language of ["glsl", "glsl_es", "hlsl", "slang", "wgsl", "msl", "cpp"]) {
  await page.selectOption("#take select", language);
  assert.match(fs.readFileSync(await save(page, "[data-export=shader]", `fitted.${language}`), "utf8"), /burnish_/);
}

// Whatever a file is called, names of what is taken away are those of functions.
fs.copyFileSync(file("a.burnish"), file("2-odd__näme.4 KB.burnish"));
await drop(page, ["2-odd__näme.4 KB.burnish"]);
await until(page, 3);
for (const kind of ["three", "ktx2", "burnish"]) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-export=${kind}]`)]);
  assert.match(download.suggestedFilename(), /^brdf_2_odd_n_me_4_KB[._]/);
}
await page.click("#list .close >> nth=2");
await page.click("#list .pick >> nth=1");

// Edits are undone and redone, and the figures beside them are those of what is shown.
const edited = "#edit input[data-edit=scale]";
const psnr = () => page.textContent("#figures tbody tr[data-shown] td:nth-child(2)");
const fittedPsnr = await psnr();
await page.locator(edited).fill("0.6");
await page.waitForFunction(() => window.figuresOf(window.studio.entries[1])?.psnr < 40);
assert.equal(Number(await psnr()), Number((await opened(page))[1].figures.psnr.toPrecision(4)));
same((await opened(page))[1].figures, JSON.parse(run("compare", "--json", file("a.binary"), await save(page, "[data-export=burnish]", "edited.burnish")))[0], "compare");
await page.click("#undo");
await page.waitForFunction((selector) => document.querySelector(selector).value === "0", edited);
await page.waitForFunction((text) => document.querySelector("#figures tbody tr[data-shown] td:nth-child(2)").textContent === text, fittedPsnr);
await page.click("#redo");
await page.waitForFunction((selector) => document.querySelector(selector).value !== "0", edited);
await page.click("#undo");

// A burst of keys is one step, the next burst another.
const places = async (...steps) => {
  for (const [act, value] of steps) {
    await act();
    await page.waitForFunction(([selector, expected]) => document.querySelector(selector).value === expected, [edited, value]);
  }
};
const press = (count) => page.focus(edited).then(() => Promise.all(Array.from({length: count}, () => page.keyboard.press("ArrowRight"))));
const undo = () => page.click("#undo"), redo = () => page.click("#redo");
await places([() => press(3), "0.09"], [() => page.waitForTimeout(1500), "0.09"], [() => press(2), "0.15"], [undo, "0.09"], [undo, "0"], [redo, "0.09"], [undo, "0"]);

// What takes long shows so, and is stopped: an export, an edit, whose slider goes back, and what a file is.
const stopped = async (button, click = () => page.click(button)) => {
  await click();
  await page.waitForFunction(() => document.querySelector("#message-text").textContent.startsWith("Stopped"));
  await page.waitForSelector(button, {state: "hidden"});
  await page.click("#message-close");
};
const slow = (method) => page.evaluate((name) => {
  const {original, material} = window.studio.entries[1], of = original ?? material, quick = of[name];
  of[name] = (how, ...rest) => {
    const {signal} = rest.at(-1);
    of[name] = quick;
    return new Promise((_, reject) => signal.addEventListener("abort", () => reject(signal.reason)));
  };
}, method);
await page.waitForFunction(() => window.studio.entries[1].material === window.studio.entries[1].original);
const exported = await page.evaluate(() => `[data-of="${window.studio.entries[1].id}"] [data-export=merl]`);
await slow("export");
await page.click(exported);
await stopped("#take-panel .busy button");
assert.ok(fs.statSync(await save(page, exported, "after.binary")).size > 1000);
const canUndo = await page.isEnabled("#undo"), figured = await page.textContent("#figures tbody");
await slow("edit");
await page.locator(edited).fill("0.6");
await stopped("#edit-panel .busy button");
assert.equal(await page.inputValue(edited), "0");
assert.equal(await page.isEnabled("#undo"), canUndo);
assert.equal(await page.textContent("#figures tbody"), figured);
await drop(page, ["whole.binary"]);
await stopped("#opening-stop", () => page.evaluate(async (button) => {
  while (window.studio.entries.length < 3) await new Promise((next) => setTimeout(next, 1));
  if (window.studio.entries[2].info) throw new Error("what it is is there before it is asked");
  document.querySelector(button).click();
}, "#opening-stop"));
assert.equal((await opened(page)).length, 2);

// A link carries the model, and what is no model is said to be none.
await page.click("#link");
await page.waitForFunction(() => document.querySelector("#link").dataset.link);
const link = await page.getAttribute("#link", "data-link");
assert.deepEqual(requests.filter((url) => !url.startsWith("blob:")), [], "requests after loading");
await steady(page, "fit");

// Without a clipboard it is shown to be copied; what would be too long to be read is not made.
await page.evaluate(() => Object.defineProperty(navigator, "clipboard", {value: undefined}));
await page.click("#link");
await page.waitForSelector("#link-text", {state: "visible"});
assert.equal(await page.inputValue("#link-text"), link);
assert.match(await page.evaluate(async () => {
  const {linkOf} = await import("./link.js");
  try {
    return linkOf("x", new Uint8Array(800_000));
  } catch (error) {
    return error.message;
  }
}), /at most 1,048,576 characters/);

requests.length = 0;
const other = await visit(link, {colorScheme: "dark"});
const loaded = requests.length;
await other.context().setOffline(true);
await until(other, 1);
const [linked] = await opened(other);
same(linked.info, JSON.parse(run("info", "--json", saved)), "linked");
await settled(other);
await accessible(other, "dark");
const foreign = fs.readFileSync(file("a.exr")).toString("base64url");  // read where it is dropped
for (const bad of ["#m=x.!!!", "#m=<b>.AAAA", "#m=x.AAAAAAAA", `#m=x.${"A".repeat(5000)}`, `#m=x.${foreign}`, `#m=x.${"A".repeat(1 << 20)}`]) {
  await other.evaluate((hash) => (location.hash = hash), bad);
  await other.waitForFunction(() => document.querySelector("#message").dataset.kind === "error" && !document.querySelector("#message").hidden);
  await other.click("#message-close");
}
assert.equal((await opened(other)).length, 1);
await other.evaluate((hash) => (location.hash = hash), new URL(link).hash);
await until(other, 2);
// Chromium itself asks for an icon again where the address changes
assert.deepEqual(requests.slice(loaded).filter((url) => !url.startsWith("blob:") && url !== `${address}icon.svg`), [], "requests after loading a link");

// The keyboard keeps its place: what stands for a thing that was replaced has the focus, or what is next to one that is gone.
const keyed = await visit();
const pressed = async (selector, key) => {
  await keyed.locator(selector).first().focus();
  await keyed.keyboard.press(key);
};
const focused = (selector) => keyed.waitForFunction((wanted) => document.activeElement.matches(wanted), selector);
run("convert", file("a.binary"), file("slices.exr"), "--to", "exr");
await drop(keyed, ["a.csv", "a.binary"]);
await until(keyed, 2);
await pressed("#list li:first-child .pick", "Enter");
await focused("#list li:first-child .pick[aria-pressed=true]");
await Promise.all([keyed.waitForEvent("download"), pressed("#take [data-export=csv]", "Enter")]);
await focused("#take [data-export=csv]");
await pressed("#handles button", "Delete");
await focused("#add-light");
await pressed("#list li:first-child .close", "Enter");
await until(keyed, 1);
await focused("#list li:first-child .close");

// What is closed while it is fitted is fitted no longer; slices are no light, and a picture that is wrong is said as other files are.
await keyed.fill("#fetches", "");
await keyed.click("#fit-start");
await keyed.waitForFunction(() => !document.querySelector("#fitting").hidden);
await pressed("#list .close", "Enter");
await keyed.waitForFunction(() => document.querySelector("#fitting").hidden);
await focused("#choose");
await drop(keyed, ["slices.exr"]);
await keyed.waitForFunction(() => /^slices.exr: .*expected a string attribute 'burnish'/.test(document.querySelector("#message-text").textContent));
assert.equal(await keyed.inputValue("#around"), "studio");
await drop(keyed, ["lie.hdr", "garbage.bin"]);
await keyed.waitForFunction(() => /^lie.hdr: .*\(and 1 more of 2 files could not be opened: garbage.bin\)$/.test(document.querySelector("#message-text").textContent));
await keyed.keyboard.press("Escape");
assert.equal(await message(keyed), "");
await keyed.setViewportSize({width: 320, height: 700});
assert.ok(await keyed.evaluate(() => document.documentElement.scrollWidth <= 320));
await keyed.context().close();

// Phone: nothing is wider than the page.
const phone = await visit(address, {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, hasTouch: true, isMobile: true, colorScheme: "light"});
await phone.selectOption("#start", "sample");
await until(phone, 1);
await settled(phone);
assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth <= 390));

// A finger turns the object and the lobe, both ways, and the page stays where it is; a tap removes a light.
const fingers = await phone.context().newCDPSession(phone);
async function swipe(selector, dx, dy) {
  await phone.locator(selector).scrollIntoViewIfNeeded();
  const {x, y, width, height} = await phone.locator(selector).boundingBox();
  const touch = (type, ...touchPoints) => fingers.send("Input.dispatchTouchEvent", {type, touchPoints});
  const at = (k) => ({x: x + 0.4 * width + dx * k, y: y + 0.5 * height + dy * k});
  await touch("touchStart", at(0));
  for (let k = 1; k <= 6; ++k) await touch("touchMove", at(k / 6));
  await touch("touchEnd");
}
for (const [selector, dx, dy] of [["#view", 80, 0], ["#view", 0, 60], ["#lobe canvas", 60, 0], ["#lobe canvas", 0, 60]]) {
  await phone.locator(selector).scrollIntoViewIfNeeded();
  await settled(phone);
  const before = await phone.locator(selector).screenshot(), top = await phone.evaluate(() => scrollY);
  await swipe(selector, dx, dy);
  await settled(phone);
  assert.notDeepEqual(await phone.locator(selector).screenshot(), before, `${selector} by ${dx}, ${dy}`);
  assert.equal(await phone.evaluate(() => scrollY), top);
}

// It drags the incident ray down, and what a fit adds moves nothing.
await phone.locator("#slices").scrollIntoViewIfNeeded();
await phone.evaluate(() => (window.top0 = scrollY));
await swipe("#slices .handle", -30, 60);
await phone.waitForFunction(() => document.querySelector("#theta").value > 45);
assert.equal(await phone.evaluate(() => scrollY - window.top0), 0);
await steady(phone, "phone");
await phone.fill("#budget", "700");
await phone.click("#fit-start");
await until(phone, 2);
await settled(phone);
await steady(phone, "a fit on a phone");
await phone.click("#list .close >> nth=1");
await phone.tap("#remove-light");
assert.equal(await phone.locator("#handles button").count(), 0);
assert.ok(await phone.isDisabled("#remove-light"));
await phone.tap("#add-light");
await phone.evaluate(() => scrollTo(0, 0));
await settled(phone);
await accessible(phone, "phone");
const pace = await measured();
const [alone, shared] = [await threaded(await visit()), await threaded(await visit(isolatedAddress))];
assert.deepEqual([alone.isolated, shared.isolated], [false, true]);
assert.deepEqual(shared.models, alone.models, "the bits that threads find");
await withoutThreads();
assert.deepEqual(complaints, [], "console");

if (figures) await pictures();
await browser.close();
for (const each of servers) each.close();
console.log(`studio: MERL's size parsed in ${times.map(([ms]) => ms.toFixed(0))} ms, seen ${times.map(([, ms]) => ms.toFixed(0))} ms later; ${hostile.refused} damaged files refused`);
console.log(`studio: MERL's size fitted to 16 KB and two fetches in ${pace.seconds.toFixed(1)} s, ${(pace.memory / 1048576).toFixed(0)} MB of the page's process at most; ${pace.frames} frames a second of SwiftShader`);
console.log(`studio: three fits in ${alone.seconds.toFixed(1)} s by one thread, ${shared.seconds.toFixed(1)} s by threads of a page that shares memory`);
console.log(`studio: ${formats.length + kMoreFormats.length} formats, fit, export and link in Chromium; ${(size / 1048576).toFixed(2)} MB compressed`);

// In the page: opens files cut short and bent, noise and lying sizes; keeps those that are refused for dropDamaged.
async function damage({seeds, step, whole}) {
  const {open} = await import("./package/index.js"), keep = await open("lambert"), unclear = [];
  const cases = [], bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  let count = 0;
  const add = (make) => count++ % step === 0 && cases.push(make());
  for (const whole of seeds.map(bytesOf)) {
    for (let length = 0; length < whole.length; ++length) add(() => whole.slice(0, length));
    for (let at = 0; at < whole.length; at += whole.length > 2000 ? 7 : 1)
      for (const byte of [0, 255, 45, 57, 110]) add(() => whole.map((b, k) => (k === at ? byte : b)));
  }
  let noise = 1;
  for (let k = 0; k < 300; ++k) add(() => Uint8Array.from({length: (37 * k) % 400}, () => (noise = (Math.imul(noise, 1664525) + 1013904223) >>> 0) >>> 24));
  const words = (...list) => [...new Uint8Array(new Uint32Array(list).buffer)], text = (of) => [...new TextEncoder().encode(of)];
  const mbsdf = text("NVIDIA ARC MBSDF V1\nMBSDF_DATA_REFLECTION=\n"), zeros = Array(1000).fill(0);
  for (const bytes of [[...words(0x5a000000, 0x5a000000, 0xb4000000), ...zeros], [...words(3600, 3600, 3600), ...zeros], [...words(0xffffffff, 90, 180), ...zeros],
                       [...mbsdf, ...words(1, 2000, 2000)], [...mbsdf, ...words(1, 0xffffffff, 2)], [...mbsdf, ...words(1, 0, 0)], text("1000\n400 410\n"),
                       text("999999999999999999999\n400\n"), text("-3\n400\n"), [...text("tensor_file"), 0, 1, 0, 255, 255, 255, 255]])
    cases.push(new Uint8Array(bytes));
  // UTIA's length is fixed, so this one file is large and few of its bytes are tried: those of a number's sign and exponent,
  // which make it huge or none at all, tiny or negative
  const utia = bytesOf(whole), kNumber = 8, refuses = new Map(), addUtia = (bytes, is) => refuses.set(bytes, is) && cases.push(bytes);
  for (const length of [1, kNumber, utia.length / 3, utia.length / 2, utia.length - kNumber, utia.length - 1]) addUtia(utia.slice(0, length), true);
  const longer = new Uint8Array(utia.length + 1);
  longer.set(utia);
  addUtia(longer, true);
  for (let k = 0; k < 20; ++k) {
    const bent = utia.slice(), byte = [255, 127, 0, 45, 110, 191][k % 6];
    bent[kNumber * ((k * 104729) % (utia.length / kNumber)) + kNumber - 1] = byte;
    addUtia(bent, [255, 127, 110].includes(byte));
  }
  window.refused = [];
  window.accepted = [];
  for (const bytes of cases) {
    try {
      (await open(bytes, {name: "bad.file"})).close();
      window.accepted.push(bytes);
      if (refuses.get(bytes)) unclear.push(`${bytes.length} bytes of UTIA are taken`);
    } catch ({message}) {
      if (refuses.get(bytes) === false) unclear.push(message);
      window.refused.push(bytes);
      if (message.includes("\n") || !message.includes("expected") || !message.includes("bad.file")) unclear.push(message);
    }
  }
  keep.close();
  return {refused: window.refused.length, accepted: window.accepted.length, unclear: unclear.slice(0, 5)};
}
async function dropDamaged({done, count}) {
  const transfer = new DataTransfer(), message = document.querySelector("#message");
  document.querySelector("#message-close").click();
  window.refused.slice(done, done + count).forEach((bytes, k) => transfer.items.add(new File([bytes], `bad${k}.file`)));
  for (const type of ["dragenter", "dragover", "drop"]) window.dispatchEvent(new DragEvent(type, {dataTransfer: transfer, cancelable: true}));
  while (message.hidden) await new Promise((next) => setTimeout(next, 5));
  return document.querySelector("#message-text").textContent;
}

function dropAccepted(k) {
  const transfer = new DataTransfer();
  transfer.items.add(new File([window.accepted[k]], "bent.file"));
  for (const type of ["dragenter", "dragover", "drop"]) window.dispatchEvent(new DragEvent(type, {dataTransfer: transfer, cancelable: true}));
}

// A page of its own that opens and fits a file of MERL's size: seconds, the most memory of its process without what
// processes share, and frames a second while its object is turned.
async function measured() {
  const session = await browser.newBrowserCDPSession(), ids = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo.filter(({type}) => type === "renderer").map(({id}) => id);
  const before = await ids(), shown = await visit();
  const own = (await ids()).filter((id) => !before.includes(id));
  let memory = 0;
  const look = setInterval(() => {
    for (const id of own) {
      const text = fs.existsSync(`/proc/${id}/status`) ? fs.readFileSync(`/proc/${id}/status`, "utf8") : "";
      memory = Math.max(memory, 1024 * Number(text.match(/RssAnon:\s+(\d+)/)?.[1] ?? 0));
    }
  }, 20);
  // chosen, since the text that drop() makes of a file takes more than the page
  await shown.setInputFiles("#files", file("whole.binary"));
  await until(shown, 1);
  await shown.waitForFunction(() => window.studio.entries[0].seen);
  await shown.focus("#view");
  let frames = 0;
  for (let k = 0; k < 40; ++k) {
    await shown.keyboard.press("ArrowRight");
    await new Promise((next) => setTimeout(next, 50));
    frames = (await shown.textContent("#pace")) || frames;
  }
  const seconds = await shown.evaluate(async () => {
    const begin = performance.now(), model = await window.studio.entries[0].material.fit({budget: 16384, fetches: 2});
    const took = (performance.now() - begin) / 1000;
    if (model.bytes > 16384 || model.fetches > 2) throw new Error(`${model.bytes} bytes, ${model.fetches} fetches`);
    model.close();
    return took;
  });
  clearInterval(look);
  await shown.context().close();
  if (own.length) assert.ok(memory > 0 && memory <= kMaxMemory, `${memory} bytes of a page that fits`);
  return {seconds, memory, frames: parseInt(frames)};
}

// Fits of one measurement, seconds, the end of one that is stopped, and what a file of noise says, in a page that asks for
// no other file meanwhile.
async function threaded(shown) {
  requests.length = 0;
  const found = await shown.evaluate(async (data) => {
    const {open} = await import("./package/index.js"), began = performance.now(), models = [];
    const material = await open(Uint8Array.from(atob(data), (c) => c.charCodeAt(0)), {name: "a.bsdf"});
    for (const options of [{budget: 1000}, {budget: 4096, fetches: 6, target: "function"}, {budget: 600, search: true}]) {
      const model = await material.fit(options);
      models.push((await model.export("burnish")).join());
      model.close();
    }
    const seconds = (performance.now() - began) / 1000, stop = new AbortController(), stopped = material.fit({budget: 65536}, {signal: stop.signal});
    setTimeout(() => stop.abort(), 200);
    return {isolated: globalThis.crossOriginIsolated, models, seconds, stopped: await stopped.catch(({name}) => name),
            refused: await open(new Uint8Array(20), {name: "noise"}).catch(({message}) => message),
            again: (await material.fit({budget: 700})).bytes};
  }, fs.readFileSync(file("a.bsdf")).toString("base64"));
  assert.equal(found.stopped, "AbortError");
  assert.match(found.refused, /^noise: offset 0: expected/);
  assert.ok(found.again <= 700);
  assert.deepEqual(requests.filter((url) => !url.startsWith("blob:")), []);
  await shown.context().close();
  return found;
}

// Where the threads' code cannot be had, or no memory that they share, a page works with the other.
async function withoutThreads() {
  const context = await browser.newContext(), [some, none] = [await context.newPage(), await context.newPage()];
  await none.route("**/burnish-threads.worker.js", (route) => route.fulfill({status: 404}));
  await some.route("**/burnish-threads.js", async (route) => {
    const response = await route.fetch(), text = await response.text();
    return route.fulfill({response, body: `WebAssembly.Memory = class { constructor() { throw new RangeError("none"); } };${text}`});
  });
  for (const shown of [some, none]) {
    await shown.goto(isolatedAddress, {waitUntil: "networkidle"});
    const {name} = await shown.evaluate(async () => (await import("./package/index.js")).open("lambert").then(({name}) => ({name})));
    assert.equal(name, "lambert");
  }
  await context.close();
}

// In the page: what is wrong with pictures of .hdr: flat rows, rows by planes, and the older repeats; lies.
async function hdrApart() {
  const {readHdr} = await import("./hdr.js"), wrong = [];
  const bytesOf = (width, height, ...rows) => new Uint8Array([...new TextEncoder().encode(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`), ...rows.flat()]);
  const check = (name, bytes, expected) => {
    const {data} = readHdr(bytes);
    if (data.length !== expected.length || expected.some((x, k) => data[k] !== x)) wrong.push(`${name}: ${data}`);
  };
  const refused = (name, bytes, most) => {
    try {
      readHdr(bytes, most);
      wrong.push(`${name}: taken`);
    } catch ({message}) {
      if (!message.startsWith(".hdr: expected")) wrong.push(`${name}: ${message}`);
    }
  };
  const pixel = (r, g, b) => [r / 128, g / 128, b / 128], [a, c] = [[128, 64, 32, 129], [64, 128, 255, 129]], [ofA, ofC] = [pixel(128, 64, 32), pixel(64, 128, 255)];
  check("flat", bytesOf(2, 2, a, c, c, a), [...ofA, ...ofC, ...ofC, ...ofA]);
  check("planes", bytesOf(9, 1, [2, 2, 0, 9], [128 + 9, 128], [128 + 8, 64, 1, 128], [9, ...Array(9).fill(32)], [128 + 9, 129]),
        [...Array(8).fill(ofA).flat(), ...pixel(128, 128, 32)]);
  check("repeats", bytesOf(5, 2, a, [1, 1, 1, 3], c, c, [1, 1, 1, 4]), [...Array(4).fill(ofA).flat(), ...Array(6).fill(ofC).flat()]);
  check("repeats of two digits", bytesOf(300, 1, a, [1, 1, 1, 43], [1, 1, 1, 1]), Array(300).fill(ofA).flat());
  refused("repeats before a pixel", bytesOf(5, 1, [1, 1, 1, 4], a));
  refused("repeats beyond the row", bytesOf(5, 1, a, [1, 1, 1, 5]));
  refused("a row cut", bytesOf(5, 1, a, c));
  refused("a lie", bytesOf(8192, 8192, a));
  refused("too large", bytesOf(20, 1, a, [1, 1, 1, 19]), 16);
  return wrong;
}

// In the page: how far RGL's tables drawn through another table, and computed besides, are from the same drawn as they are;
// largest differences, relative to the brightest light. Under a point light alone the frames settle on the same pixels.
async function computedApart(text) {
  const {View} = await import("./view.js"), {open} = await import("./package/index.js");
  const material = await open(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)), {name: "a.bsdf"});
  const methods = {evaluate: (...pairs) => material.evaluate(...pairs), volume: (size) => material.volume(size), table: async () => null};
  async function pictures(shown, ended) {
    const canvas = document.createElement("canvas"), view = new View(canvas), {gl} = view;
    Object.assign(canvas.style, {width: "80px", height: "60px", position: "fixed", top: "0"});
    document.body.append(canvas);
    view.measure = () => {};  // both of one size, however slow the machine is
    view.set({around: "none"});
    view.show({id: 1, material: shown, model: false}, null);
    while (!ended(view)) await new Promise((next) => setTimeout(next, 20));
    const pixelsOf = ({frame, width, height}) => {
      const pixels = new Float32Array(4 * width * height);
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
      return pixels;
    };
    const sum = pixelsOf(view.targets[1 + (view.frames % 2)]), off = view.off[0] && pixelsOf(view.off[0].targets[view.off[0].passes % 2]);
    canvas.remove();
    view.show(null, null);
    return {sum, off};
  }
  const whole = await pictures(material, (view) => view.settled && view.formOf(view.sides[0]));
  const other = await pictures({...methods, channels: material.channels, isotropic: material.isotropic}, (view) => view.off[0]?.passes === 16);
  const brightest = whole.sum.reduce((most, x, i) => (i % 4 < 3 ? Math.max(most, x) : most), 0);
  const apart = (picture) => picture.reduce((most, x, i) => (i % 4 < 3 ? Math.max(most, Math.abs(x - whole.sum[i])) : most), 0) / brightest;
  material.close();
  return {brightest, table: apart(other.sum), computed: apart(other.sum.map((x, i) => x + other.off[i]))};
}
// In the page: the largest relative difference between what is open as it is drawn and what it is: a surface away from its
// edges, a model in its highlight too.
async function drawnApart(isSurface) {
  const {drawnValues} = await import("./fidelity.js"), {prepare} = await import("./gpu_brdf.js"), {normalize} = await import("./vectors.js");
  const gl = document.createElement("canvas").getContext("webgl2"), entry = window.studio.entries[0], pairs = [];
  gl.getExtension("EXT_color_buffer_float");
  for (let k = 0; k < 60; ++k) {
    const wi = normalize([Math.sin(k), 0.5 * Math.cos(3 * k), 1]);
    pairs.push([wi, isSurface || k % 2 ? normalize([Math.cos(2 * k), Math.sin(5 * k), 1.2]) : [-wi[0], -wi[1], wi[2]]]);
  }
  let form;
  await prepare(gl, entry, () => true, (made) => (form = made));
  const drawn = drawnValues(gl, form, pairs), of = isSurface ? await entry.material.place(0.5, 0.5) : entry.material;
  const exact = await of.evaluate(pairs.flatMap(([wi]) => wi), pairs.flatMap(([, wo]) => wo));
  if (isSurface) of.close();
  return Math.max(...exact.map((value, i) => Math.abs(drawn[i] / value - 1)));
}
// In the page: how many numbers of two pictures are not the same, of which OpenEXR read the second.
async function lightApart(texts) {
  const {readExr} = await import("./exr.js"), [given, read] = await Promise.all(texts.map((text) => readExr(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)))));
  return given.data.length === read.data.length ? given.data.filter((x, k) => x !== read.data[k]).length : Infinity;
}
// In the page: the largest relative difference between two pictures as they are read.
async function lightFar(texts) {
  const {readExr} = await import("./exr.js"), [given, read] = await Promise.all(texts.map((text) => readExr(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)))));
  if (given.data.length !== read.data.length) return Infinity;
  return given.data.reduce((most, x, k) => Math.max(most, Math.abs(x - read.data[k]) / Math.max(Math.abs(read.data[k]), 0.01)), 0);
}
// In the page: the largest relative difference between a picture as it is read and as burnish_input_files wrote it.
async function lightOff(text) {
  const {readExr} = await import("./exr.js"), {width, height, data} = await readExr(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
  let most = width === 801 && height === 45 ? 0 : 1;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      [0.25 * (x % 75), Math.exp(0.1 * y), 1 + Math.sin(0.3 * x * y)].forEach((value, c) => {
        most = Math.max(most, Math.abs(data[3 * (y * width + x) + c] - value) / Math.max(value, 0.01));
      });
  return most;
}

// One dark, one light, one phone.
async function pictures() {
  await phone.screenshot({path: path.join(figures, "studio-phone.png")});
  for (const [colorScheme, shape, around] of [["dark", "sphere", "studio"], ["light", "teapot", "sky"]]) {
    const shown = await visit(address, {colorScheme});
    await shown.selectOption("#start", "sample");
    await until(shown, 1);
    await shown.click(`#shape [data-value=${shape}]`);
    await shown.selectOption("#around", around);
    if (shape === "teapot") await shown.selectOption("#curve", "2");
    await shown.fill("#budget", "2700");
    await shown.fill("#fetches", "2");
    await shown.click("#fit-start");
    await until(shown, 2);
    await settled(shown);
    await shown.screenshot({path: path.join(figures, `studio-${colorScheme}.png`)});
  }
}
