// node studio.mjs SITE BURNISH FOLDER [FIGURES]: the page in SITE (build/studio) in headless Chromium, beside the command
// line BURNISH. Files go into FOLDER, where burnish_input_files wrote its own; screenshots into FIGURES if it is given.
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
const kMostBytes = 3 << 20;       // of the page, compressed
const kSame = 1e-6;               // relative, between the page's figures and the command line's
const kMostShift = 0.05;         // of Chromium's layout shift while files are opened and fitted
const kExact = 60;               // dB, of what is drawn from a measurement's own tables
const kComputed = 1e-5;          // of the brightest light, between what is computed and what is drawn of RGL's own tables
const kPatience = 120_000;        // milliseconds; the renderer is software
const kHostileStep = Number(process.env.HOSTILE_STEP ?? 11);
const axe = fs.readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const run = (...args) => execFileSync(burnish, args, {stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 28}).toString();
const file = (name) => path.join(folder, name);
fs.mkdirSync(folder, {recursive: true});

// Server of the site, and what was asked of it.
const kTypes = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".wasm": "application/wasm"};
const server = http.createServer((request, response) => {
  const asked = path.join(site, path.normalize(new URL(request.url, "http://x").pathname)), found = asked.endsWith("/") ? `${asked}index.html` : asked;
  if (!fs.existsSync(found)) return response.writeHead(404).end();
  response.writeHead(200, {"content-type": kTypes[path.extname(found)] ?? "application/octet-stream"}).end(fs.readFileSync(found));
});
await new Promise((done) => server.listen(0, done));
const address = `http://localhost:${server.address().port}/`;

const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]});
const complaints = [], requests = [];
async function visit(link = address, options = {}) {
  const context = await browser.newContext({viewport: {width: 1440, height: 940}, acceptDownloads: true, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  page.on("console", (said) => ["error", "warning"].includes(said.type()) && !/GPU stall|GL Driver Message/.test(said.text()) && complaints.push(said.text()));
  page.on("pageerror", (error) => complaints.push(error.stack));
  page.on("request", (request) => requests.push(request.url()));
  await page.addInitScript(() => {
    window.shifted = 0;
    new PerformanceObserver((list) => list.getEntries().forEach((entry) => !entry.hadRecentInput && (window.shifted += entry.value)))
      .observe({type: "layout-shift", buffered: true});
  });
  await page.goto(link, {waitUntil: "networkidle"});
  await page.evaluate(async () => (window.studio = (await import("./state.js")).state));
  return page;
}

const compared = (source) => JSON.parse(run("compare", "--json", "--count", "2000", source, file("a.burnish")))[0];
// What the page has open, and messages.
const opened = (page) => page.evaluate(() => window.studio.entries.map(({name, info, figures, parent}) => ({name, info, figures, parent})));
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
const settled = (page) => page.waitForFunction(() => document.documentElement.dataset.view === "settled");

// Numbers alike to kSame, at the same places; a path in a name is no difference. A node whose cosine is the threshold counts
// or not by the last bit of another library's arc cosine, and what predicts such nodes from others hangs on them.
const kNames = ["name", "model", "note", "predicted", "itself"], kCounts = {count: 1e-3};
function same(found, expected, at, within = kSame) {
  if (typeof expected === "number") {
    assert.ok(Math.abs(found - expected) <= within * Math.max(Math.abs(expected), 1e-9), `${at}: expected ${expected}, found ${found}`);
  } else if (expected !== null && typeof expected === "object") {
    for (const key of Object.keys(expected).filter((name) => !kNames.includes(name))) same(found?.[key], expected[key], `${at}.${key}`, kCounts[key] ?? within);
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
  const alta = ["#SAMPLE \"a\"", "#DIM 3 1", "#VS 1", "#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI", "#PARAM_OUT INV_STERADIAN"], cornell = ["# a", "# a", "3", "450 550 650"];
  for (const thetaI of [0.2, 0.5, 0.9])
    for (const thetaO of [0.1, 0.4, 0.7, 1])
      for (const phi of [0.3, 1.2, 2.1, 3]) {
        const cosine = Math.cos(thetaI) * Math.cos(thetaO) - Math.sin(thetaI) * Math.sin(thetaO) * Math.cos(phi), f = 0.05 + 0.4 * Math.max(cosine, 0) ** 9;
        alta.push([thetaI, thetaO * Math.cos(phi), thetaO * Math.sin(phi), f, 0.01].join(" "));
        cornell.push([thetaI, 0, thetaO, phi, f, 0.8 * f, 0.5 * f].join(" "));
      }
  fs.writeFileSync(file("a.alta"), `${alta.join("\n")}\n`);
  fs.writeFileSync(file("a.cornell"), `${cornell.join("\n")}\n`);
}
// Nothing moved since the last time that this was asked.
async function steady(page, what) {
  const shifted = await page.evaluate(() => [window.shifted, (window.shifted = 0)][0]);
  assert.ok(shifted <= kMostShift, `${what}: layout shifted by ${shifted}`);
}
async function accessible(page, what) {
  await page.evaluate(axe);
  const violations = await page.evaluate(async () => (await window.axe.run()).violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" ").slice(0, 400)}`));
  assert.deepEqual(violations, [], `${what}: axe`);
}

// The page's size.
const ofPage = [...fs.readdirSync(site).filter((name) => /\.(html|js|css|svg)$/.test(name)), ...fs.readdirSync(path.join(site, "package")).map((name) => `package/${name}`)];
const sizes = ofPage.map((name) => path.join(site, name)).map((name) => zlib.gzipSync(fs.readFileSync(name), {level: 9}).length);
const size = sizes.reduce((sum, bytes) => sum + bytes, 0);
assert.ok(size <= kMostBytes, `expected at most ${kMostBytes} bytes compressed, found ${size}`);

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
                  "Speos": "seed.speos", "OpenMATERIAL 3D": "a.xompt", "ALTA": "a.alta", "ASTM E1392": "a.astm", "CSV": "a.csv", "Cornell": "a.cornell",
                  "model, OpenEXR": "a.exr", "model, compact": "a.burnish", "baseline": "seed.baseline", "network weights": "seed.neural"};
const kMoreFormats = ["book of a library", "Neural Processes codes"];  // tried apart
const listed = run("help", "formats").split("\n").filter((line) => / (both|read) /.test(line)).map((line) => line.split(/ {2,}/)[0]);
assert.deepEqual([...Object.keys(kFormats), ...kMoreFormats].sort(), listed.sort());
const formats = [...Object.values(kFormats), "dgf.json"];
fs.writeFileSync(file("garbage.bin"), "nothing of the kind <img src=x onerror=alert(1)>");
fs.writeFileSync(file("cut.bsdf"), fs.readFileSync(file("a.bsdf")).subarray(0, 3000));
fs.writeFileSync(file("huge.binary"), Buffer.from([255, 255, 255, 127, 255, 255, 255, 127, 255, 255, 255, 127, 0, 0]));
fs.writeFileSync(file("empty.csv"), "");

const page = await visit();
requests.length = 0;
await accessible(page, "empty page");

// Every format at once: what the panel says is what `info --json` says.
await drop(page, formats);
await until(page, formats.length);
for (const {name, info} of await opened(page)) same(info, JSON.parse(run("info", "--json", file(name))), name);
assert.match(await page.textContent("#info"), /isotropic/);

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
const hostile = await page.evaluate(damage, {seeds: seeds.map((name) => fs.readFileSync(file(name)).toString("base64")), step: kHostileStep});
assert.deepEqual(hostile.unclear, []);
assert.ok(hostile.refused > 30000 / kHostileStep / 3, `${hostile.refused} refused`);
for (let done = 0; done < hostile.refused; done += 200) {
  const count = Math.min(200, hostile.refused - done), said = await page.evaluate(dropDamaged, {done, count});
  assert.ok(/expected/.test(said) && !said.includes("\n") && (count === 1 || said.includes(`(and ${count - 1} more of ${count} files`)), said);
}
assert.equal((await opened(page)).length, 0);
await page.click("#message-close");

// Memory of a file of MERL's size is given back; how long until it is seen.
if (!fs.existsSync(file("whole.binary"))) run("convert", spec, file("whole.binary"), "--to", "merl");
await drop(page, ["a.burnish"]);
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
const apart = await page.evaluate(surfaceApart);
assert.ok(apart < 5e-3, `a surface is drawn ${apart} from what it is`);
run("export", file("flat.burnish"), "--to", "three", "-o", file("surface"));
assert.equal(fs.readFileSync(await save(page, "[data-export=three]", "flat.three.js"), "utf8"), fs.readFileSync(file("surface/flat.three.js"), "utf8"));
await accessible(page, "surface");
await page.click("#list .close >> nth=0");
await until(page, 0);
await page.click("#shape [data-value=sphere]");

// Light from pictures, in every compression that is read.
for (const kind of ["none", "rle", "zips", "zip", "piz"]) {
  await drop(page, [`light-${kind}.exr`]);
  await page.waitForFunction((name) => document.querySelector("#message-text").textContent === `${name} lights the object`, `light-${kind}.exr`);
  assert.equal(await page.inputValue("#around"), "picture");
  assert.ok((await page.evaluate(lightApart, fs.readFileSync(file(`light-${kind}.exr`)).toString("base64"))) < 1e-3, kind);
}
await drop(page, ["light-b44.exr"]);
await page.waitForFunction(() => /expected a compression of .*, found B44/.test(document.querySelector("#message-text").textContent));
await page.click("#message-close");
await page.selectOption("#around", "studio");

await steady(page, "books, surfaces and pictures");

// Fit: figures equal those of the command line for the saved model.
await drop(page, ["a.binary"]);
await until(page, 1);
await settled(page);
await page.fill("#budget", "2700");
await page.fill("#fetches", "2");
await page.click("#fit-start");
await until(page, 2);
const [, model] = await opened(page);
const saved = await save(page, "[data-export=burnish]", "fitted.burnish");
const [expected] = JSON.parse(run("compare", "--json", file("a.binary"), saved));
same(model.figures, expected, "compare");
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

// What is taken away is there; shaders say what they are.
for (const [kind, name] of [["ktx2", "fitted.ktx2"], ["three", "fitted.three.js"], ["merl", "out.binary"], ["csv", "out.csv"], ["png", "view.png"], ["slice", "slice.svg"]])
  assert.ok(fs.statSync(await save(page, `[data-export=${kind}]`, name)).size > 100, kind);
for (const language of ["glsl", "glsl_es", "hlsl", "wgsl", "msl", "cpp"]) {
  await page.selectOption("#take select", language);
  assert.match(fs.readFileSync(await save(page, "[data-export=shader]", `fitted.${language}`), "utf8"), /burnish_/);
}

// Edits are undone and redone.
const edited = "#edit input[data-edit=scale]";
if (await page.locator(edited).count()) {
  await page.focus(edited);
  await page.keyboard.press("ArrowRight");
  assert.notEqual(await page.inputValue(edited), "0");
  await page.click("#undo");
  await page.waitForFunction((selector) => document.querySelector(selector).value === "0", edited);
  await page.click("#redo");
  await page.waitForFunction((selector) => document.querySelector(selector).value !== "0", edited);
  await page.click("#undo");
}

// A link carries the model, and what is no model is said to be none.
await page.click("#link");
await page.waitForFunction(() => document.querySelector("#link").dataset.link);
const link = await page.getAttribute("#link", "data-link");
assert.deepEqual(requests.filter((url) => !url.startsWith("blob:")), [], "requests after loading");
await steady(page, "fit");

const other = await visit(link, {colorScheme: "dark"});
await until(other, 1);
const [linked] = await opened(other);
same(linked.info, JSON.parse(run("info", "--json", saved)), "linked");
await settled(other);
await accessible(other, "dark");
for (const bad of ["#m=x.!!!", "#m=<b>.AAAA", "#m=x.AAAAAAAA", `#m=x.${"A".repeat(5000)}`]) {
  await other.evaluate((hash) => (location.hash = hash), bad);
  await other.waitForFunction(() => document.querySelector("#message").dataset.kind === "error" && !document.querySelector("#message").hidden);
  await other.click("#message-close");
}
assert.equal((await opened(other)).length, 1);

// Phone: nothing is wider than the page.
const phone = await visit(address, {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, hasTouch: true, isMobile: true, colorScheme: "light"});
await phone.selectOption("#start", "sample");
await until(phone, 1);
await settled(phone);
assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth <= 390));
await accessible(phone, "phone");
assert.deepEqual(complaints, [], "console");

if (figures) await pictures();
await browser.close();
server.close();
console.log(`studio: MERL's size parsed in ${times.map(([ms]) => ms.toFixed(0))} ms, seen ${times.map(([, ms]) => ms.toFixed(0))} ms later; ${hostile.refused} damaged files refused`);
console.log(`studio: ${formats.length + kMoreFormats.length} formats, fit, export and link in Chromium; ${(size / 1048576).toFixed(2)} MB compressed`);

// In the page: opens files cut short and bent, noise and lying sizes; keeps those that are refused for dropDamaged.
async function damage({seeds, step}) {
  const {open} = await import("./package/index.js"), keep = await open("lambert"), unclear = [];
  const cases = [], bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  let count = 0;
  const add = (make) => count++ % step === 0 && cases.push(make());
  for (const whole of seeds.map(bytesOf)) {
    for (let length = 0; length < whole.length; ++length) add(() => whole.slice(0, length));
    for (let at = 0; at < whole.length; at += whole.length > 2000 ? 7 : 1)
      for (const byte of [0, 255, 45, 57, 110]) add(() => whole.map((b, k) => (k === at ? byte : b)));
  }
  for (let k = 0; k < 300; ++k) add(() => crypto.getRandomValues(new Uint8Array((37 * k) % 400)));
  const words = (...list) => [...new Uint8Array(new Uint32Array(list).buffer)], text = (of) => [...new TextEncoder().encode(of)];
  const mbsdf = text("NVIDIA ARC MBSDF V1\nMBSDF_DATA_REFLECTION=\n"), zeros = Array(1000).fill(0);
  for (const bytes of [[...words(0x5a000000, 0x5a000000, 0xb4000000), ...zeros], [...words(3600, 3600, 3600), ...zeros], [...words(0xffffffff, 90, 180), ...zeros],
                       [...mbsdf, ...words(1, 2000, 2000)], [...mbsdf, ...words(1, 0xffffffff, 2)], [...mbsdf, ...words(1, 0, 0)], text("1000\n400 410\n"),
                       text("999999999999999999999\n400\n"), text("-3\n400\n"), [...text("tensor_file"), 0, 1, 0, 255, 255, 255, 255]])
    cases.push(new Uint8Array(bytes));
  window.refused = [];
  for (const bytes of cases) {
    try {
      (await open(bytes, {name: "bad.file"})).close();
    } catch ({message}) {
      window.refused.push(bytes);
      if (message.includes("\n") || !message.includes("expected") || !message.includes("bad.file")) unclear.push(message);
    }
  }
  keep.close();
  return {refused: window.refused.length, unclear: unclear.slice(0, 5)};
}
async function dropDamaged({done, count}) {
  const transfer = new DataTransfer(), message = document.querySelector("#message");
  document.querySelector("#message-close").click();
  window.refused.slice(done, done + count).forEach((bytes, k) => transfer.items.add(new File([bytes], `bad${k}.file`)));
  for (const type of ["dragenter", "dragover", "drop"]) window.dispatchEvent(new DragEvent(type, {dataTransfer: transfer, cancelable: true}));
  while (message.hidden) await new Promise((next) => setTimeout(next, 5));
  return document.querySelector("#message-text").textContent;
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
  return {table: apart(other.sum), computed: apart(other.sum.map((x, i) => x + other.off[i]))};
}
// In the page: the largest relative difference between a surface as it is drawn, away from its edges, and its place.
async function surfaceApart() {
  const {drawnValues} = await import("./fidelity.js"), {prepare} = await import("./gpu_brdf.js"), {normalize} = await import("./vectors.js");
  const gl = document.createElement("canvas").getContext("webgl2"), entry = window.studio.entries[0], pairs = [];
  gl.getExtension("EXT_color_buffer_float");
  for (let k = 0; k < 60; ++k) pairs.push([normalize([Math.sin(k), 0.5 * Math.cos(3 * k), 1]), normalize([Math.cos(2 * k), Math.sin(5 * k), 1.2])]);
  let form;
  await prepare(gl, entry, () => true, (made) => (form = made));
  const drawn = drawnValues(gl, form, pairs), place = await entry.material.place(0.5, 0.5);
  const exact = await place.evaluate(pairs.flatMap(([wi]) => wi), pairs.flatMap(([, wo]) => wo));
  place.close();
  return Math.max(...exact.map((value, i) => Math.abs(drawn[i] / value - 1)));
}
// In the page: the largest relative difference between a picture as it is read and as burnish_input_files wrote it.
async function lightApart(text) {
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
