// Asks the site's own search what a reader would: node tests/docs/search.mjs SITE
// SITE is what `make site` built. Its search worker runs here as it does in a browser, on the index that was built.
// Prints the first three pages of each question and ends with 1 where the page with the answer is not among them.
import fs from "node:fs";
import path from "node:path";

const kQuestions = {
  "RGL to MERL": "guide/formats.html",
  "area light": "guide/area-lights.html",
  "pow without pow": "guide/specular.html",
  "where is the mirror direction": "notation.html",
};

const site = process.argv[2];
if (!site) {
  console.error("usage: node tests/docs/search.mjs SITE");
  process.exit(2);
}
const workers = path.join(site, "assets/javascripts/workers");
if (!fs.existsSync(workers)) {
  console.error(`${workers}: expected the search worker of a site, found none`);
  process.exit(1);
}
const worker = fs.readdirSync(workers).find((name) => name.endsWith(".js"));
const index = JSON.parse(fs.readFileSync(path.join(site, "search/search_index.json"), "utf8"));

// A worker's world: it listens to messages and posts its answers.
let listener, answered;
globalThis.self = globalThis;
globalThis.addEventListener = (_, heard) => { listener = heard; };
globalThis.postMessage = (message) => answered(message);
(0, eval)(fs.readFileSync(path.join(workers, worker), "utf8"));
const ask = (type, data) => new Promise((resolve) => { answered = resolve; listener({ data: { type, data } }); });

await ask(0, { config: index.config, docs: index.docs, options: { suggest: false } });
let wrong = 0;
for (const [question, page] of Object.entries(kQuestions)) {
  const { data } = await ask(2, question);
  const pages = data.items.map((found) => found[0].location.split("#")[0]).slice(0, 3);
  const found = pages.includes(page);
  wrong += !found;
  console.log(`${question}: ${pages.join(", ") || "nothing"}${found ? "" : `; expected ${page} among them`}`);
}
process.exit(wrong ? 1 : 0);
