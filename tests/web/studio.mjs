// node studio.mjs SITE BURNISH FOLDER [FIGURES]: the page in SITE (build/studio) in headless Chromium, beside the command
// line BURNISH. Files go into FOLDER; screenshots into FIGURES if it is given.
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
const kPatience = 120_000;        // milliseconds; the renderer is software
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
const kNames = ["name", "model", "note", "predicted"], kCounts = {count: 1e-3};
function same(found, expected, at, within = kSame) {
  if (typeof expected === "number") {
    assert.ok(Math.abs(found - expected) <= within * Math.max(Math.abs(expected), 1e-9), `${at}: expected ${expected}, found ${found}`);
  } else if (expected !== null && typeof expected === "object") {
    for (const key of Object.keys(expected).filter((name) => !kNames.includes(name))) same(found?.[key], expected[key], `${at}.${key}`, kCounts[key] ?? within);
  } else {
    assert.equal(found, expected, at);
  }
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

// A file of every format that is written.
const spec = "ggx:alpha_x=0.25,alpha_y=0.25,f0=0.9/0.6/0.3,kd=0.05";
for (const [name, ...more] of [["a.binary", "--to", "merl", "--cells", "20"], ["a.bsdf", "--to", "rgl"], ["a.mbsdf", "--to", "mbsdf"], ["z.bsdf", "--to", "zemax"],
                               ["a.astm", "--to", "astm", "--count", "2000"], ["a.csv", "--to", "csv", "--count", "2000"]])
  if (!fs.existsSync(file(name))) run("convert", spec, file(name), ...more);
run("fit", spec, "--model", "pqp", "--samples", "20000", "-o", file("a.burnish"));
run("convert", file("a.burnish"), file("a.exr"));
const formats = ["a.binary", "a.bsdf", "a.mbsdf", "z.bsdf", "a.astm", "a.csv", "a.burnish", "a.exr"];
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

// Garbage: one clear line each, and the page works on.
for (const name of ["garbage.bin", "cut.bsdf", "huge.binary", "empty.csv"]) {
  await drop(page, [name]);
  await page.waitForFunction((n) => document.querySelector("#message").dataset.kind === "error" && document.querySelector("#message-text").textContent.includes(n), name);
  assert.ok(!(await message(page)).includes("\n"));
}
assert.equal((await opened(page)).length, formats.length);
for (let k = 0; k < formats.length; ++k) await page.click("#list .close >> nth=0");
await until(page, 0);

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
const [compared] = JSON.parse(run("compare", "--json", file("a.binary"), saved));
same(model.figures, compared, "compare");
run("fit", file("a.binary"), "--budget", "2700", "--fetches", "2", "-o", file("native.burnish"));
const [native] = JSON.parse(run("compare", "--json", file("a.binary"), file("native.burnish")));
assert.ok(Math.abs(native.psnr - compared.psnr) < 0.05, `fitted natively ${native.psnr} dB, in the page ${compared.psnr} dB`);
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
assert.ok((await page.evaluate(() => window.shifted)) <= kMostShift, `layout shifted by ${await page.evaluate(() => window.shifted)}`);

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
console.log(`studio: ${formats.length} formats, fit, export and link in Chromium; ${(size / 1048576).toFixed(2)} MB compressed`);

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
