// node catalogue.mjs LIBRARY [FIGURE] [STUDIO]: the page of a batch in the folder LIBRARY in headless Chromium, from a server and
// from the disk. Prints how long it takes to open, sort, find and scroll. A screenshot goes into the folder FIGURE; with
// STUDIO (build/studio) a material is opened there.
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import {createRequire} from "node:module";
import path from "node:path";
import {pathToFileURL} from "node:url";
import {chromium} from "playwright-core";

const [library, figure, studio] = process.argv.slice(2).map((name) => name && path.resolve(name));
const kMaxOpenTime = 2000, kMaxSortTime = 100;  // milliseconds
const axe = fs.readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

const kTypes = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".png": "image/png", ".wasm": "application/wasm"};
const server = http.createServer((request, response) => {
  const asked = path.normalize(new URL(request.url, "http://x").pathname);
  const found = asked.startsWith("/studio/") && studio ? path.join(studio, asked.slice(7)) : path.join(library, asked.endsWith("/") ? "index.html" : asked);
  if (!fs.existsSync(found)) return response.writeHead(404).end();
  response.writeHead(200, {"content-type": kTypes[path.extname(found)] ?? "application/octet-stream"}).end(fs.readFileSync(found));
});
await new Promise((done) => server.listen(0, done));
const address = `http://localhost:${server.address().port}/`;

const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]});
const complaints = [], requests = [];
async function visit(link, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 860}, ...options});
  const page = await context.newPage();
  page.on("console", (said) => ["error", "warning"].includes(said.type()) && complaints.push(said.text()));
  page.on("pageerror", (error) => complaints.push(error.stack));
  page.on("request", (request) => requests.push(request.url()));
  const start = performance.now();
  await page.goto(link, {waitUntil: "load"});
  await page.waitForSelector(".card");
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  page.opened = performance.now() - start;
  return page;
}
const names = (page) => page.evaluate(() => [...document.querySelectorAll(".card a")].sort((a, b) => a.dataset.place - b.dataset.place).map((a) => a.textContent));
const count = (page) => page.textContent("#count");
// Milliseconds of what an event does and of the frame after it.
const timed = (page, selector, event, value) => page.evaluate(async ([where, kind, to]) => {
  const target = document.querySelector(where), start = performance.now();
  if (to !== undefined) target.value = to;
  if (kind === "click") target.click();
  else target.dispatchEvent(new Event(kind));
  document.body.offsetHeight;  // lays out
  return performance.now() - start;
}, [selector, event, value]);
async function accessible(page, what) {
  await page.evaluate(axe);
  const violations = await page.evaluate(async () => (await window.axe.run()).violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" ").slice(0, 400)}`));
  assert.deepEqual(violations, [], `${what}: axe`);
}

await (await browser.newPage()).goto("about:blank");  // what a browser's first page takes is not the library's
// What the page shows is what the batch has.
const all = JSON.parse(fs.readFileSync(path.join(library, "page/materials.js"), "utf8").replace(/^catalogueMaterials\(|\);\n$/g, ""));
const page = await visit(address, {colorScheme: "dark"});
assert.equal(await count(page), `${all.materials.length} materials`);
assert.ok(page.opened <= kMaxOpenTime, `expected the page in ${kMaxOpenTime} ms, found ${page.opened}`);
assert.ok((await names(page)).length < 200, "expected cards that are seen alone");
assert.equal(await page.isVisible("#failures"), all.failed.length > 0);

// Sorting by every figure, both ways; of three times the best, since others use the machine.
let slowest = 0;
for (const value of await page.$$eval("#sort option", (options) => options.map((option) => option.value))) {
  const times = [];
  for (let k = 0; k < 3; ++k) times.push(Math.max(await timed(page, "#sort", "change", value), await timed(page, "#order", "click"), await timed(page, "#order", "click")));
  slowest = Math.max(slowest, Math.min(...times));
}
assert.ok(slowest <= kMaxSortTime, `expected every order within ${kMaxSortTime} ms, found ${slowest}`);
await timed(page, "#sort", "change", "psnr");
const worst = Math.min(...all.materials.map(({psnr}) => psnr ?? Infinity));
const first = (await names(page))[0];
assert.equal(all.materials.find(({name}) => name === first).psnr ?? Infinity, worst, "expected the worst first");

// Finding by words and figures.
const median = [...all.materials].map(({psnr}) => psnr ?? 0).sort((a, b) => a - b)[all.materials.length >> 1];
const find = await timed(page, "#find", "input", `psnr<${median}`);
assert.equal(await count(page), `${all.materials.filter(({psnr}) => psnr !== null && psnr < median).length} of ${all.materials.length} materials`);
await timed(page, "#find", "input", "no-such-material");
assert.equal(await count(page), `0 of ${all.materials.length} materials`);
await timed(page, "#find", "input", "");

// Scrolling from top to bottom: the longest that drawing keeps a frame.
const stutter = await page.evaluate(async () => {
  let longest = 0;
  const end = document.documentElement.scrollHeight;
  for (let y = 0; y <= end; y += 400) {
    const start = performance.now();
    window.scrollTo(0, y);
    window.dispatchEvent(new Event("scroll"));
    await new Promise(requestAnimationFrame);
    const drawn = performance.now();
    document.body.offsetHeight;
    longest = Math.max(longest, performance.now() - drawn);
    if (performance.now() - start > 1000) throw new Error("a frame took a second");
  }
  window.scrollTo(0, 0);
  return longest;
});

// The keyboard: to a card, along the cards, into the comparison.
await timed(page, "#sort", "change", "name");
await page.focus("#theme");
await page.keyboard.press("Tab");
await page.keyboard.press("ArrowRight");
await page.keyboard.press(" ");
await page.keyboard.press("ArrowRight");
await page.keyboard.press(" ");
assert.equal(await page.$$eval("#compared thead th", (cells) => cells.length), Math.min(3, all.materials.length), "expected two compared materials");
if (all.materials.length > 60) {
  await page.keyboard.press("End");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.place), String(all.materials.length - 1));
  await page.keyboard.press("Home");
}
await page.keyboard.press("/");
assert.equal(await page.evaluate(() => document.activeElement.id), "find");
await accessible(page, "dark");

// One card is reached by Tab, after a search and wherever the page was scrolled to.
const tabbed = () => page.$$eval('.card a[tabindex="0"]', (links) => links.map((link) => Number(link.dataset.place)));
await page.keyboard.press("Escape");
await timed(page, "#find", "input", all.materials.at(-1).name);
assert.deepEqual(await tabbed(), [0], "expected Tab to go to the first card found");
await timed(page, "#find", "input", "");
assert.deepEqual(await tabbed(), [0], "expected Tab to go to the first card of all");
await page.evaluate(async () => {
  document.activeElement.blur();
  window.scrollTo(0, document.documentElement.scrollHeight);
  window.dispatchEvent(new Event("scroll"));
  await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
});
assert.equal((await tabbed()).length, 1, "expected one card that Tab goes to at the end of the list");
await page.evaluate(() => window.scrollTo(0, 0));

// A link carries the model's own bytes, loaded when the pointer is there.
await page.hover(".card a.name[href]");
const href = await page.waitForFunction(() => [...document.querySelectorAll("a.name")].find((a) => a.href.includes("#m="))?.href).then((handle) => handle.jsonValue());
const [, short, data] = href.match(/#m=([\w-]*)\.([\w-]*)$/);
const linked = all.materials.find(({name, linked: has}) => has && name.replace(/[^\w-]+/g, "_").slice(0, 40) === short);
if (linked.file.endsWith(".burnish")) assert.deepEqual(Buffer.from(data, "base64url"), fs.readFileSync(path.join(library, linked.file)));
if (studio) {
  const opened = await (await browser.newContext()).newPage();
  await opened.goto(href, {waitUntil: "load"});
  await opened.waitForSelector("#list li", {timeout: 60_000});
  assert.match(await opened.textContent("#list"), new RegExp(short.slice(0, 8)));
}

// Light, and from the disk.
await timed(page, "#sort", "change", "albedo");
await page.evaluate(() => window.scrollTo(0, 0));
if (figure) await page.screenshot({path: path.join(figure, "library-dark.png")});
await page.click("#theme");
await page.keyboard.press("Escape");
await accessible(page, "light");
requests.length = 0;
const local = await visit(pathToFileURL(path.join(library, "index.html")).href, {colorScheme: "light"});
assert.equal(await count(local), `${all.materials.length} materials`);
if (figure) await local.screenshot({path: path.join(figure, "library-light.png")});
await local.hover(".card a.name[href]");
await local.waitForFunction(() => [...document.querySelectorAll("a.name")].some((a) => a.href.includes("#m=")));
assert.deepEqual(requests.filter((url) => !url.startsWith("file:")), [], "expected nothing from elsewhere");
assert.deepEqual(complaints, [], "expected a silent console");
console.log(`catalogue: ${all.materials.length} materials open in ${page.opened.toFixed(0)} ms, from the disk in ${local.opened.toFixed(0)} ms; sort in ${slowest.toFixed(1)} ms, ` +
  `find in ${find.toFixed(1)} ms, a frame while scrolling lays out in ${stutter.toFixed(1)} ms`);
await browser.close();
server.close();
