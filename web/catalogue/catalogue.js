// Shows all materials of a library. page/materials.js calls catalogueMaterials with their figures. page/models-K.js
// calls catalogueModels with the models of a part, and is loaded when one of its links is wanted. Only cards in sight
// exist.
"use strict";
(() => {
  const kWidth = 188, kHeight = 218, kSphere = 96, kAround = 2;  // pixels of a card with its gap; rows beyond the edges
  const kMaxCompared = 8, kThousands = new Intl.NumberFormat("en");
  // Figures to sort and compare by: a heading, the text of a value, and which way is better.
  const kFigures = {
    name: {label: "name", text: (v) => v, better: 0},
    psnr: {label: "psnr", text: (v) => `${v.toFixed(2)} dB`, better: 1},
    ssim: {label: "ssim", text: (v) => v.toFixed(4), better: 1},
    relative: {label: "relative error", text: (v) => v.toFixed(3), better: -1},
    rms_log: {label: "rms_log", text: (v) => v.toFixed(3), better: -1},
    log_cos: {label: "log_cos", text: (v) => v.toFixed(4), better: -1},
    bytes: {label: "bytes", text: (v) => kThousands.format(v), better: -1},
    fetches: {label: "fetches", text: (v) => String(v), better: -1},
    albedo: {label: "albedo", text: (v) => v.toFixed(3), better: 0},
    seconds: {label: "seconds", text: (v) => v.toFixed(2), better: -1},
    warnings: {label: "warnings", text: (v) => String(v), better: -1},
  };
  const at = (id) => document.getElementById(id);
  let library = null, shown = [], picked = [];
  let focused = 0;  // place of the card that Tab goes to
  const cards = new Map();  // place among the shown -> card
  const parts = new Map();  // number -> {promise, links}

  const valueOf = (material, figure) => (figure === "warnings" ? material.warnings.length : material[figure]);
  const textOf = (material, figure) => {
    const value = valueOf(material, figure);
    return value === null ? "–" : kFigures[figure].text(value);
  };
  function element(tag, properties = {}, ...children) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  }

  // --- shown materials

  // Returns a test for a word, or for a figure compared with a number. Text that is no comparison is a word; nothing is
  // thrown.
  function testOf(word) {
    const [, figure, sign, number] = word.match(/^(\w+)(<=|>=|<|>|=)(-?[\d.]+(?:e-?\d+)?)$/) ?? [];
    if (!figure || !kFigures[figure] || figure === "name" || Number.isNaN(Number(number)))
      return ({words}) => words.includes(word.toLowerCase());
    const bound = Number(number);
    const holds = {"<": (v) => v < bound, ">": (v) => v > bound, "=": (v) => v === bound, "<=": (v) => v <= bound, ">=": (v) => v >= bound}[sign];
    return (material) => valueOf(material, figure) !== null && holds(valueOf(material, figure));
  }

  // Materials without a value stand last in both orders.
  function select() {
    const tests = at("find").value.split(/\s+/).filter(Boolean).map(testOf);
    const figure = at("sort").value, sign = at("order").getAttribute("aria-pressed") === "true" ? -1 : 1;
    const compare = (a, b) => {
      const x = valueOf(a, figure), y = valueOf(b, figure);
      if (x === null || y === null) return (x === null) - (y === null) || a.index - b.index;
      return sign * (figure === "name" ? a.order - b.order : x - y) || a.index - b.index;
    };
    shown = library.materials.filter((material) => tests.every((test) => test(material))).sort(compare);
    at("materials").replaceChildren();
    cards.clear();
    focused = 0;
    at("count").textContent = shown.length === library.materials.length ? `${shown.length} materials` : `${shown.length} of ${library.materials.length} materials`;
    draw();
  }

  const columns = () => Math.max(1, Math.floor((at("materials").clientWidth + 12) / kWidth));

  // Makes the cards in sight and removes the other cards.
  function draw() {
    const list = at("materials"), across = columns(), top = -list.getBoundingClientRect().top;
    const first = Math.max(0, Math.floor(top / kHeight) - kAround) * across;
    const last = Math.min(shown.length, (Math.ceil((top + window.innerHeight) / kHeight) + kAround) * across);
    list.style.height = `${Math.ceil(shown.length / across) * kHeight}px`;
    for (const [place, card] of cards) {
      if (place >= first && place < last) continue;
      if (card.contains(document.activeElement)) continue;  // the keyboard's focus is there
      card.remove();
      cards.delete(place);
    }
    const made = document.createDocumentFragment();
    for (let place = first; place < last; ++place) {
      if (!cards.has(place)) {
        cards.set(place, cardOf(shown[place], place));
        made.append(cards.get(place));
      }
    }
    for (const [place, card] of cards)
      card.style.transform = `translate(${(place % across) * kWidth}px, ${Math.floor(place / across) * kHeight}px)`;
    list.append(made);
    // Tab goes to an existing card. Where its card was scrolled away, it goes to the first card in sight.
    if (cards.size === 0 || cards.has(focused)) return;
    const seen = Math.max(0, Math.ceil(top / kHeight)) * across;
    focused = cards.has(seen) ? seen : first;
    cards.get(focused).querySelector("a").tabIndex = 0;
  }

  function sphereOf(material) {
    const sphere = element("span", {className: "sphere"});
    const sheet = Math.floor(material.index / library.perSheet), k = material.index % library.perSheet;
    sphere.style.backgroundImage = `url("page/pictures-${sheet}.png")`;
    sphere.style.backgroundPosition = `-${(k % library.columns) * kSphere}px -${Math.floor(k / library.columns) * kSphere}px`;
    return sphere;
  }

  function cardOf(material, place) {
    const link = element("a", {className: "name", textContent: material.name, title: `${material.name}: ${material.model}`, tabIndex: place === focused ? 0 : -1});
    link.dataset.place = place;
    if (material.linked) {
      link.href = hrefOf(material) ?? library.studio;
      link.target = "_blank";
      link.rel = "noopener";
    }
    const compare = element("button", {type: "button", textContent: "+", title: "Compare", tabIndex: -1});
    compare.dataset.compare = place;
    compare.setAttribute("aria-label", `Compare ${material.name}`);
    compare.setAttribute("aria-pressed", picked.includes(material));
    const card = element("li", {className: picked.includes(material) ? "card picked" : "card"}, sphereOf(material), link,
      element("p", {textContent: `${material.psnr === null ? "" : `${textOf(material, "psnr")}, `}error ${textOf(material, "relative")}`}),
      element("p", {textContent: `${textOf(material, "bytes")} bytes, ${textOf(material, "fetches")} fetches`}),
      element("p", {textContent: `albedo ${textOf(material, "albedo")}`}), compare);
    if (material.warnings.length > 0)
      card.append(element("p", {className: "warning", textContent: material.warnings.join("; "), title: material.warnings.join("\n")}));
    card.setAttribute("aria-setsize", shown.length);
    card.setAttribute("aria-posinset", place + 1);
    return card;
  }

  // --- links to the studio

  const partOf = (material) => Math.floor(material.index / library.perPart);

  function hrefOf(material) {
    const links = parts.get(partOf(material))?.links;
    const name = material.name.replace(/[^\w-]+/g, "_").slice(0, 40);
    return links ? `${library.studio}#m=${name}.${links[material.index % library.perPart]}` : null;
  }

  // Loads the models of a material's part, once.
  function load(material) {
    const number = partOf(material);
    if (!parts.has(number)) {
      const part = {links: null};
      part.promise = new Promise((done, fail) => {
        part.done = done;
        const script = element("script", {src: `page/models-${number}.js`, onerror: () => fail(new Error(`page/models-${number}.js cannot be read`))});
        document.head.append(script);
      });
      parts.set(number, part);
    }
    return parts.get(number).promise;
  }
  window.catalogueModels = ({part, links}) => {
    parts.get(part).links = links;
    for (const link of document.querySelectorAll("a.name[href]")) {
      const material = shown[link.dataset.place];
      if (material && partOf(material) === part) link.href = hrefOf(material);
    }
    parts.get(part).done();
  };

  // --- compared materials

  function pick(material) {
    if (!picked.includes(material)) picked = [...picked, material].slice(-kMaxCompared);
    else picked = picked.filter((each) => each !== material);
    for (const [place, card] of cards) {
      card.classList.toggle("picked", picked.includes(shown[place]));
      card.querySelector("button").setAttribute("aria-pressed", picked.includes(shown[place]));
    }
    at("comparison").hidden = picked.length === 0;
    at("compared").replaceChildren(tableOf(picked));
    draw();
  }

  function tableOf(materials) {
    const head = element("tr", {}, element("th", {textContent: "material", scope: "col"}),
      ...materials.map((material) => element("th", {scope: "col"}, sphereOf(material), material.name)));
    const rows = Object.entries(kFigures).filter(([figure]) => figure !== "name").map(([figure, {label, better}]) => {
      const values = materials.map((material) => valueOf(material, figure)).filter((value) => value !== null);
      const best = better > 0 ? Math.max(...values) : better < 0 ? Math.min(...values) : null;
      return element("tr", {}, element("th", {textContent: label, scope: "row"}), ...materials.map((material) =>
        element("td", {textContent: textOf(material, figure), className: materials.length > 1 && valueOf(material, figure) === best ? "best" : ""})));
    });
    return element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
  }

  // --- keyboard and pointer

  function focus(place) {
    const to = Math.min(Math.max(place, 0), shown.length - 1);
    if (to < 0) return;
    const list = at("materials").getBoundingClientRect().top + window.scrollY, row = list + Math.floor(to / columns()) * kHeight;
    const above = document.querySelector("header").offsetHeight + 8;
    if (row - above < window.scrollY) window.scrollTo(0, row - above);
    else if (row + kHeight > window.scrollY + window.innerHeight) window.scrollTo(0, row + kHeight - window.innerHeight);
    cards.get(focused)?.querySelector("a").setAttribute("tabindex", "-1");
    focused = to;
    draw();
    const link = cards.get(to).querySelector("a");
    link.tabIndex = 0;
    link.focus({preventScroll: true});
  }
  const placeOf = (target) => target.closest?.("a.name")?.dataset.place;

  function onKey(event) {
    const typing = event.target.matches?.("input, select, textarea");
    if (event.key === "/" && !typing) {
      event.preventDefault();
      at("find").focus();
      return;
    }
    const place = placeOf(event.target);
    if (place === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const across = columns(), page = across * Math.max(1, Math.floor(window.innerHeight / kHeight) - 1);
    const steps = {ArrowLeft: -1, ArrowRight: 1, ArrowUp: -across, ArrowDown: across, PageUp: -page, PageDown: page, Home: -Infinity, End: Infinity};
    if (event.key in steps) focus(Math.min(Math.max(Number(place) + steps[event.key], 0), shown.length - 1));
    else if (event.key === " ") pick(shown[place]);
    else return;
    event.preventDefault();
  }

  // A link whose model is not loaded yet opens once it is.
  async function onClick(event) {
    const compare = event.target.closest("button[data-compare]");
    if (compare) return pick(shown[compare.dataset.compare]);
    const place = placeOf(event.target);
    if (place === undefined || !shown[place].linked || hrefOf(shown[place])) return;
    event.preventDefault();
    const material = shown[place];
    try {
      await load(material);
      window.open(hrefOf(material), "_blank", "noopener");
    } catch (error) {
      at("count").textContent = error.message;
    }
  }
  const prepare = (event) => {
    const place = placeOf(event.target);
    if (place !== undefined && shown[place].linked) load(shown[place]).catch(() => {});
  };

  function setTheme() {
    const dark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    document.documentElement.dataset.theme = dark ? "light" : "dark";
  }

  window.catalogueMaterials = (given) => {
    library = given;
    library.materials.forEach((material, index) => Object.assign(material, {index, words: `${material.name} ${material.path} ${material.format} ${material.warnings.join(" ")}`.toLowerCase()}));
    // Places by name are found once, since comparing texts takes longer than comparing numbers.
    const collator = new Intl.Collator("en", {numeric: true});
    [...library.materials].sort((a, b) => collator.compare(a.name, b.name)).forEach((material, k) => (material.order = k));
    for (const [name, {label}] of Object.entries(kFigures)) at("sort").append(new Option(label, name));
    at("failures").hidden = library.failed.length === 0;
    at("failures-title").textContent = `${library.failed.length} not fitted`;
    at("failed").append(...library.failed.map(({name, path, reason}) => element("li", {}, element("b", {textContent: name}), " ", element("code", {textContent: path}), `: ${reason}`)));

    at("find").addEventListener("input", select);
    at("sort").addEventListener("change", select);
    at("order").addEventListener("click", () => {
      at("order").setAttribute("aria-pressed", at("order").getAttribute("aria-pressed") !== "true");
      select();
    });
    at("clear").addEventListener("click", () => {
      picked = [picked[0]];
      pick(picked[0]);
    });
    at("theme").addEventListener("click", setTheme);
    at("materials").addEventListener("pointerover", prepare);
    at("materials").addEventListener("focusin", (event) => {
      prepare(event);
      const place = placeOf(event.target);
      if (place !== undefined) focused = Number(place);
    });
    document.addEventListener("click", onClick);
    document.addEventListener("keydown", onKey);
    let waiting = false;
    const redraw = () => {
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        draw();
      });
    };
    window.addEventListener("scroll", redraw, {passive: true});
    window.addEventListener("resize", redraw);
    select();
  };
})();
