// What tests/docs/axe.sh runs, from the folder that has playwright-core and axe-core: node axe.mjs SITE [PICTURES]
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import {createRequire} from "node:module";
import {chromium} from "playwright-core";

const [site, pictures] = process.argv.slice(2);
const axe = fs.readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
// A page of each kind: pictures, formulas and tables, code, hover cards, notebooks.
const kPages = ["index.html", "guide/fitting.html", "notes/specular.html", "api/fitting.html", "notation.html",
  "results/frame-cost.html", ...fs.existsSync(path.join(site, "notebooks")) ?
    fs.readdirSync(path.join(site, "notebooks")).filter((name) => name.endsWith(".html")).map((name) => `notebooks/${name}`) : []];
const kLooks = {
  light: {colorScheme: "light", viewport: {width: 1280, height: 860}},
  dark: {colorScheme: "dark", viewport: {width: 1280, height: 860}},
  phone: {colorScheme: "light", viewport: {width: 390, height: 844}},
};

const kTypes = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml",
  ".png": "image/png", ".json": "application/json"};
const server = http.createServer((request, response) => {
  const file = path.join(site, path.normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)));
  if (!fs.existsSync(file) || fs.statSync(file).isDirectory()) return response.writeHead(404).end();
  response.writeHead(200, {"content-type": kTypes[path.extname(file)] ?? "application/octet-stream"}).end(fs.readFileSync(file));
});
await new Promise((done) => server.listen(0, done));
const address = `http://localhost:${server.address().port}/`;

const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox",
  "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"]});
const wrong = [];
for (const [look, options] of Object.entries(kLooks)) {
  const context = await browser.newContext(options);
  for (const name of kPages) {
    const page = await context.newPage();
    page.on("request", (request) => request.url().startsWith(address) || request.url().startsWith("data:") ||
      wrong.push(`${look}, ${name}: asks ${request.url()}`));
    page.on("pageerror", (error) => wrong.push(`${look}, ${name}: ${error.message}`));
    await page.goto(address + name, {waitUntil: "load"});
    await page.waitForTimeout(300);  // the theme's scripts change the page once more
    await page.evaluate(axe);
    const violations = await page.evaluate(async () => (await window.axe.run()).violations.map((violation) =>
      `${violation.id}: ${violation.nodes.length} x ${violation.nodes[0].html.slice(0, 200)}`));
    for (const violation of violations) wrong.push(`${look}, ${name}: ${violation}`);
    const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    if (wider > 0) wrong.push(`${look}, ${name}: ${wider} pixels wider than the screen`);
    if (pictures) {
      fs.mkdirSync(pictures, {recursive: true});
      await page.screenshot({path: path.join(pictures, `${name.replace(/\W/g, "-")}-${look}.png`)});
    }
    await page.close();
  }
}
await browser.close();
server.close();
console.log(wrong.length ? wrong.join("\n") : `${kPages.length} pages, ${Object.keys(kLooks).length} looks: nothing wrong`);
process.exit(wrong.length ? 1 : 0);
