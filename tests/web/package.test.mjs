// The package burnish in Node, beside the command line: the same figures for a source of every format.
import assert from "node:assert/strict";
import {execFile} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {after, before, describe, test} from "node:test";
import {pathToFileURL} from "node:url";
import {promisify} from "node:util";

const cli = path.resolve(process.env.BURNISH_CLI), folder = path.resolve(process.env.BURNISH_INPUTS);
const {memory, Model, open} = await import(pathToFileURL(path.resolve(process.env.BURNISH_PACKAGE, "index.js")).href);

const kSpec = "ggx:alpha_x=0.25,alpha_y=0.25,f0=0.8/0.5/0.3,kd=0.05/0.1/0.15";
const kTolerance = 1e-6;  // relative, of every figure
const kKrigedTolerance = 2e-3;  // of what is kriged: exponentials of floats round otherwise here, and solving magnifies that
const kExpectedTolerance = 1e-2;  // of expected errors: square roots of differences of floats, near measured points
const kFitTolerance = 0.05, kKrigedFitTolerance = 0.5;  // dB
const kExact = 80;  // dB, above which nothing but rounding is left to differ

const run = async (...args) => (await promisify(execFile)(cli, args, {maxBuffer: 1 << 28})).stdout;
const at = (name) => path.join(folder, name);
const bytesOf = (file) => new Uint8Array(fs.readFileSync(file));

// Formats whose functions between samples or nodes are kriged; what was measured is what is fitted, but of what shines back.
const isKriged = (format) => /(RGL|CSV|ASTM|ALTA|OpenMATERIAL|Cornell)$/.test(format), shinesBack = (format) => /ALTA$/.test(format);

// Where the two differ by more than a share of them, or nothing.
function difference(found, expected, share = kTolerance, place = "") {
  if (typeof expected === "number" && typeof found === "number") {
    const scale = Math.max(Math.abs(expected), Math.abs(found), 1e-9);
    const most = place.startsWith("/nodes/predicted") ? kKrigedTolerance : /^\/\d+\/expected/.test(place) ? kExpectedTolerance : share;
    return Math.abs(found - expected) <= most * scale ? undefined : `${place}: ${found} instead of ${expected}`;
  }
  if (expected === null || typeof expected !== "object")
    return Object.is(found, expected) ? undefined : `${place}: ${found} instead of ${expected}`;
  if (found === null || typeof found !== "object") return `${place}: ${found} instead of an object`;
  const names = new Set([...Object.keys(expected), ...Object.keys(found)]);
  for (const name of names) {
    const differs = difference(found[name], expected[name], share, `${place}/${name}`);
    if (differs) return differs;
  }
  return undefined;
}

// Unit vectors above the horizon, the same each time.
function directions(count, seed) {
  let state = seed;
  const uniform = () => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32);
  const list = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const z = 0.05 + 0.95 * uniform(), phi = 2 * Math.PI * uniform(), r = Math.sqrt(1 - z * z);
    list.set([r * Math.cos(phi), r * Math.sin(phi), z], 3 * i);
  }
  return list;
}

const kKlems = (() => {
  const patches = 145, values = Array.from({length: patches * patches}, (_, i) => (0.1 + 0.05 * Math.sin(i)).toFixed(5));
  const rings = [[0, 5, 1], [5, 15, 8], [15, 25, 16], [25, 35, 20], [35, 45, 24], [45, 55, 24], [55, 65, 24], [65, 75, 16], [75, 90, 12]];
  const blocks = rings.map(([low, high, count]) => `<AngleBasisBlock><ThetaBounds><LowerTheta>${low}</LowerTheta>` +
    `<UpperTheta>${high}</UpperTheta></ThetaBounds><nPhis>${count}</nPhis></AngleBasisBlock>`).join("\n");
  return `<?xml version="1.0"?>\n<!-- a blind --><WindowElement><Optical><Layer><Material><Name>blind &amp; slat</Name></Material>
<DataDefinition><IncidentDataStructure>Columns</IncidentDataStructure>
<AngleBasis><AngleBasisName>LBNL/Klems Full</AngleBasisName>${blocks}</AngleBasis></DataDefinition>
<WavelengthData><Wavelength unit="Integral">Visible</Wavelength><WavelengthDataBlock>
<WavelengthDataDirection>Reflection Front</WavelengthDataDirection>
<ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis><RowAngleBasis>LBNL/Klems Full</RowAngleBasis>
<ScatteringData>${values.join(",")}</ScatteringData></WavelengthDataBlock></WavelengthData>
</Layer></Optical></WindowElement>\n`;
})();

// One source of every format; measured ones where $BURNISH_DATA has them.
const sources = {
  MERL: at("a.binary"), RGL: at("a.bsdf"), MBSDF: at("a.mbsdf"), Zemax: at("a.zemax"), ASTM: at("a.astm"),
  CSV: at("a.csv"), Klems: at("a.xml"), UTIA: at("a.bin"), OpenMATERIAL: at("a.xompt"), "a tensor tree": at("tree.xml"),
  "a baseline": at("a.json"), "a compact model": at("a.burnish"), "an OpenEXR model": at("a.exr"),
};
const data = process.env.BURNISH_DATA;
if (data)
  for (const [name, file] of Object.entries({
    "measured Cornell": "cornell/cayman.brdf", "measured Klems": "klems/mecho_shade_fabric_aniso.xml",
    "measured MBSDF": "mbsdf/carpaint_blue.mbsdf", "measured ALTA": "retro/retro-gray-tape.dat", "measured Speos": "speos/aniso_bsdf.anisotropicbsdf",
    "a measured tensor tree": "tensortree/t3.xml", "measured OpenMATERIAL": "openmaterial/example_material_camera_brdf.xompt",
    "measured Zemax": "zemax/AnoBlackEC1onAlum.bsdf", "another measured Zemax": "zemax/IMX455.bsdf", "measured RGL": "rgl/chm_mint_rgb.bsdf"}))
    if (fs.existsSync(path.join(data, file))) sources[name] = path.join(data, file);

before(async () => {
  fs.writeFileSync(at("a.xml"), kKlems);
  await run("fit", kSpec, "--model", "pqp", "--samples", "20000", "-o", at("a.exr"));
  await run("convert", at("a.exr"), at("a.burnish"));
  await run("convert", kSpec, at("a.binary"), "--cells", "40");
  await run("convert", kSpec, at("a.mbsdf"), "--cells", "16");
  await run("convert", kSpec, at("a.bsdf"));
  await run("convert", kSpec, at("a.zemax"), "--to", "zemax");
  await run("convert", kSpec, at("a.astm"), "--count", "3000");
  await run("convert", kSpec, at("a.csv"), "--count", "3000");
  await run("convert", kSpec, at("a.bin"), "--to", "utia");
  await run("convert", kSpec, at("a.xompt"), "--count", "3000");
  await run("convert", "lambert:kd=0.4", at("tree.xml"), "--to", "tensortree");
  await run("fit", kSpec, "--method", "dgf", "--budget", "600", "-o", at("a.json"));
});

for (const [format, file] of Object.entries(sources))
  describe(format, () => {
    let material;
    const share = isKriged(format) ? kKrigedTolerance : kTolerance;
    before(async () => { material = await open(bytesOf(file), {name: file}); });
    after(() => material?.close());

    test("is told about as `info --json` does", async () => {
      const expected = JSON.parse(await run("info", file, "--json"));
      assert.equal(difference(await material.info(), expected, share), undefined);
    });

    test("is fitted as `fit` does", async () => {
      const budget = format.endsWith("Klems") ? 1000 : 300, natively = run("fit", file, "--budget", `${budget}`, "-o", at("native.burnish")).catch(() => undefined);
      const model = await material.fit({budget}).catch(({message}) => message);
      if (await natively === undefined) return assert.match(model, /expected/);
      const native = await open(bytesOf(at("native.burnish"))), [own, theirs] = await material.compare([model, native]);
      const most = isKriged(format) ? kKrigedFitTolerance : kFitTolerance;
      assert.ok(Math.abs(own.psnr - theirs.psnr) < most || Math.min(own.psnr, theirs.psnr) > kExact, `${own.psnr} dB, natively ${theirs.psnr} dB`);
      for (const each of [model, native]) each.close();
    });

    test("follows nodes of isotropic RGL files and of samples that do not shine back", () => {
      assert.equal(material.target, isKriged(format) && !shinesBack(format) ? "nodes" : "function");
    });

    test("is evaluated as `eval` does", async () => {
      const count = 200, wi = directions(count, 1), wo = directions(count, 2);
      const rows = Array.from({length: count}, (_, i) => [...wi.slice(3 * i, 3 * i + 3), ...wo.slice(3 * i, 3 * i + 3)].join(","));
      fs.writeFileSync(at("pairs.csv"), ["wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", ...rows].join("\n") + "\n");
      await run("eval", file, at("pairs.csv"), "-o", at("values.csv"));
      const expected = fs.readFileSync(at("values.csv"), "utf8").trim().split("\n").slice(1).flatMap((row) => row.split(",").map(Number));
      const found = await material.evaluate(wi, wo);
      assert.equal(found.length, expected.length);
      for (let i = 0; i < found.length; ++i)
        assert.ok(Object.is(found[i], expected[i]) || Math.abs(found[i] - expected[i]) <= Math.max(share, 1e-5) * Math.abs(expected[i]) + 1e-9, `${i}: ${found[i]}, ${expected[i]}`);
    });

    test("is compared as `compare --json` does", async () => {
      const model = await open(bytesOf(at("a.burnish")), {name: at("a.burnish")});
      const expected = JSON.parse(await run("compare", file, at("a.burnish"), "--json", "--count", "20000"));
      const found = await material.compare(model, {count: 20000});
      model.close();
      assert.equal(difference(found, expected, share), undefined);
    });
  });

test("A fit is the command line's", async () => {
  const material = await open(bytesOf(sources.MERL)), stages = [];
  const model = await material.fit(
    {budget: 16384, fetches: 2}, {onProgress: (fraction) => stages.push(fraction)});
  assert.ok(model instanceof Model && model.bytes <= 16384 && model.fetches <= 2);
  assert.ok(stages.length > 3 && stages.every((f) => f >= 0 && f <= 1));
  await run("fit", sources.MERL, "--budget", "16K", "--fetches", "2", "-o", at("native.burnish"));
  const native = await open(bytesOf(at("native.burnish")));
  const [own, theirs] = await material.compare([model, native]);
  assert.ok(Math.abs(own.psnr - theirs.psnr) < kFitTolerance, `${own.psnr} dB, natively ${theirs.psnr} dB`);
  for (const each of [material, model, native]) each.close();
});

test("A fit that is aborted stops, and what is open stays open", async () => {
  const material = await open(kSpec), control = new AbortController();
  let begin;
  setTimeout(() => {
    begin = performance.now();
    control.abort();
  }, 500);
  await assert.rejects(material.fit({budget: 65536}, {signal: control.signal}), {name: "AbortError"});
  assert.ok(performance.now() - begin < 1000);
  assert.equal((await material.info()).format, "analytic");
  const early = new AbortController();
  early.abort();
  await assert.rejects(material.fit({budget: 2700}, {signal: early.signal}), {name: "AbortError"});
  material.close();
});

test("An answer that is aborted does not close other materials", async () => {
  const [one, other] = [await open(bytesOf(sources.MERL)), await open(kSpec)], control = new AbortController();
  const volume = one.volume({thetaH: 200, thetaD: 200, phiD: 200}, {signal: control.signal, onProgress: () => control.abort()});
  await assert.rejects(volume, {name: "AbortError"});
  assert.equal((await other.evaluate([0, 0, 1], [0, 0, 1])).length, 3);
  assert.equal((await one.evaluate([0, 0, 1], [0, 0, 1])).length, 3);
  one.close();
  other.close();
});

test("Whatever takes a signal is stopped by it, and what is open stays open", async () => {
  const material = await open(bytesOf(sources.MERL)), model = await open(bytesOf(at("a.burnish"))), up = [0, 0, 1];
  const many = Float32Array.from({length: 3_000_000}, (_, i) => up[i % 3]);
  for (const [name, ask] of Object.entries({
    info: (call) => material.info(call), evaluate: (call) => material.evaluate(many, many, call),
    albedo: (call) => material.albedo(Array(500).fill(0.5), call), compare: (call) => material.compare(model, {}, call),
    images: (call) => material.images(model, {size: 512}, call), export: (call) => material.export("merl", {}, call),
    shader: (call) => model.shader("glsl", {}, call), edit: (call) => model.edit({roughness: 2}, call), table: (call) => material.table(call),
  })) {
    const control = new AbortController(), asked = ask({signal: control.signal});
    control.abort();
    await assert.rejects(asked, {name: "AbortError"}, name);
    assert.equal((await material.evaluate(up, up)).length, 3, name);
  }
  const control = new AbortController(), asked = material.compare(model, {count: 2_000_000}, {signal: control.signal}), begin = performance.now();
  setTimeout(() => control.abort(), 100);
  await assert.rejects(asked, {name: "AbortError"});
  assert.ok(performance.now() - begin < 1000);
  assert.equal((await model.evaluate(up, up)).length, 3);
  material.close();
  model.close();
});

test("What was asked of a material before it is closed is answered, and the worker ends", async () => {
  const material = await open(kSpec), up = [0, 0, 1];
  const asked = [material.volume({thetaH: 20, thetaD: 20, phiD: 20}), material.evaluate(up, up), material.albedo([0.5])];
  material.close();
  for (const answer of await Promise.all(asked)) assert.ok(answer);
  await new Promise((next) => setTimeout(next, 50));
  assert.equal(memory(), 0);
});

test("Lights, the back side and values with the cosine are read as the command line reads them", async (t) => {
  const rows = [], waves = [400, 450, 500, 550, 600, 650, 700];
  for (const thetaI of [10, 40, 70])
    for (const thetaO of [5, 30, 60])
      for (const phi of [0, 90, 180]) rows.push([thetaI, 0, thetaO, phi, ...waves.map((w) => (0.1 + w / 2000 + thetaI * thetaO * 1e-5).toFixed(5))].join(","));
  fs.writeFileSync(at("waves.csv"), `theta_i,phi_i,theta_o,phi_o,${waves.map((w) => `value_${w}`).join(",")}\n${rows.join("\n")}\n`);
  const albedos = [];
  for (const [options, ...args] of [[{illuminant: "D50"}, "--illuminant", "D50"], [{illuminant: "A"}, "--illuminant", "A"], [{hasCosine: true}, "--has-cosine"]]) {
    const expected = JSON.parse(await run("info", at("waves.csv"), "--json", ...args)), material = await open(bytesOf(at("waves.csv")), {name: at("waves.csv"), ...options});
    t.after(() => material.close());
    const found = await material.info();
    assert.equal(difference(found, expected, kKrigedTolerance), undefined);
    albedos.push(JSON.stringify(found.albedo));
  }
  assert.equal(new Set(albedos).size, 3);
  await assert.rejects(open(bytesOf(at("waves.csv")), {illuminant: "F2"}), /expected E, D50, D65 or A, found 'F2'/);
  const back = new TextEncoder().encode(kKlems.replace("Reflection Front", "Reflection Back"));
  // a file of the back side alone is read as that, and says so
  const alone = await open(back), material = await open(back, {back: true}), front = await open(new TextEncoder().encode(kKlems)), up = [0, 0, 1];
  t.after(() => [alone, material, front].forEach((each) => each.close()));
  const {conventions = [], warnings = []} = await alone.info();
  assert.match([...conventions, ...warnings].join(" "), /back/i);
  for (const each of [alone, material]) assert.deepEqual(await each.evaluate(up, up), await front.evaluate(up, up));
});

test("Options that there are not, and values of another kind, are said", async () => {
  const material = await open(kSpec), model = await material.fit({budget: 700});
  const refused = async (task, said) => assert.rejects(task, (error) => {
    assert.ok(error.message.includes(said) && error.message.length < 300 && !/json|undefined \(/.test(error.message), error.message);
    return true;
  });
  for (const [data, found] of [[null, "null"], [undefined, "undefined"], [5, "Number"], [[1, 2], "Array"], [{}, "Object"]]) await refused(open(data), `found ${found}`);
  await refused(open("lambert", {iluminant: "E"}), "did you mean 'illuminant'");
  await refused(open(new Uint8Array(4), {decoder: 5}), "expected a decoder as bytes");
  for (const [options, said] of [[{nosuch: 1}, "found 'nosuch'"], [{fetches: 4}, "fetches requires budget"], [{budget: 3000, fetches: 0}, "fetches: expected a whole number from 1 to 256, found '0'"], [{budget: 3000, fetches: "two"}, "found 'two'"], [{lobes: 3, search: true}, "lobes requires budget"], [{budget: 3000, fetches: 2, search: true}, "fetches excludes search"],
                                 [{budget: "much"}, "auto or a number of bytes"], [{budget: 3000, model: "z(h)"}, "budget excludes model"], [{samples: -4}, "samples: expected a whole number from 1"], [{seed: 1.5}, "found '1.5'"], [{holdOut: "half=1", target: "function"}, "target: expected nodes with holdOut, found 'function'"],
                                 [{smooth: "yes"}, "smooth: expected auto or a number"], [{floor: -1}, "floor: expected a number above 0"], [{symmetrize: 3}, "true or false"], [{tables: "q=3"}, "a list of texts"], [{name: 5}, "a name as a text"], [7, "expected"]])
    await refused(material.fit(options), said);
  await refused(material.evaluate([[0, 0, 1]], [[0, 0, 1]]), "three numbers each in one list");
  await refused(material.albedo(0.5), "a list of angles");
  await refused(material.compare(null), "expected a material, found null");
  await refused(material.compare(model, {count: -2}), "count from 1");
  await refused(material.images(5), "expected a material, found Number");
  await refused(material.volume({thetaH: 1}), "thetaH from 2 to 512");
  await refused(material.export("brnish"), "found 'brnish'; did you mean 'burnish'?");
  await refused(material.fit({budget: 700}, {onProgress: 3}), "onProgress as a function");
  await refused(material.info({signal: 3}), "signal as an AbortSignal");
  for (const wrong of [3, null, "x"])
    for (const asked of [material.info(wrong), material.volume(wrong), material.volume({}, wrong), material.table(wrong), material.albedo([0], wrong), material.compare(model, wrong),
                         material.images(model, wrong), material.export("csv", wrong), material.fit({}, wrong), model.shader("glsl", wrong), open("lambert", wrong)])
      await refused(asked, "expected options, found");
  await refused(model.export("merl", {}, {onLosses: 3}), "onLosses as a function");
  await refused(open("nosuch"), "ggx:alpha_x=0.2,alpha_y=0.2");
  for (const edit of [5, null, undefined, {nosuch: 1}, {hue: "x"}, {roughness: "x"}, {diffuse: -1}]) await refused(model.edit(edit), "expected");
  await refused(model.shader(), "expected glsl");
  await refused(model.shader("glsl", {exact: "yes"}), "true or false");
  material.close();
  model.close();
});

test("Garbage is one clear line, and the next file opens", async () => {
  const clear = (error) => {
    assert.ok(error instanceof Error && !error.message.includes("\n") && error.message.includes("expected"), error.message);
    assert.ok(!error.message.startsWith("the library stopped"), error.message);
    return true;
  };
  await assert.rejects(open(new Uint8Array(0)), clear);
  await assert.rejects(open(new TextEncoder().encode("garbage in")), clear);
  await assert.rejects(open("no such model"), clear);
  let rejected = 0;
  for (const file of Object.values(sources).filter((f) => f.startsWith(folder))) {
    const whole = bytesOf(file);
    for (let k = 0; k < 12; ++k) {
      // cut short, or bent in the first bytes or anywhere
      const bad = k < 4 ? whole.slice(0, Math.floor(whole.length * [0.01, 0.3, 0.7, 0.999][k])) : whole.slice();
      if (k >= 4) bad[k < 8 ? 4 * k - 13 : (whole.length * k * 7919) % whole.length] ^= 0xff;
      try {
        (await open(bad, {name: "bad"})).close();
      } catch (error) {
        clear(error);
        ++rejected;
      }
    }
  }
  assert.ok(rejected > 20, `${rejected}`);
  const material = await open(bytesOf(sources.MERL));
  material.close();
  await assert.rejects(material.info(), /closed/);
});

test("Shaders, exports and volumes have what they say", async () => {
  const model = await open(bytesOf(at("a.burnish")), {name: "a"});
  for (const language of ["glsl", "glsl_es", "hlsl", "msl", "slang", "wgsl", "cpp"]) {
    const {code, textures, cost, function: called} = await model.shader(language);
    assert.ok(code.includes(called) && cost.fetches > 0);
    for (const t of textures) assert.equal(t.data.length, t.width * Math.max(t.height, 1) * Math.max(t.depth, 1) * (t.format === "rgb9e5" ? 1 : t.channels));
  }
  await run("export", at("a.burnish"), "--to", "glsl_es", "--name", "brdf", "-o", at("shaders"));
  const native = fs.readdirSync(at("shaders")).find((name) => name.endsWith(".glsl") || name.includes("glsl_es") || name.endsWith(".frag"));
  assert.ok(native, fs.readdirSync(at("shaders")).join());
  assert.equal((await model.shader("glsl_es")).code, fs.readFileSync(path.join(at("shaders"), native), "utf8"));
  assert.deepEqual(Buffer.from(await model.export("burnish")), fs.readFileSync(at("a.burnish")));
  for (const kind of ["ktx2", "cube", "png", "gltf", "materialx", "usda", "mdl", "three", "babylon", "html"]) {
    const files = await model.export(kind);
    assert.ok(files.length > 0 && files.every((file) => file.name && file.bytes.length > 0), kind);
  }
  for (const kind of ["merl", "utia", "mbsdf", "rgl", "zemax", "openmaterial", "astm", "csv", "exr"]) {
    const bytes = await model.export(kind, {cells: 12, count: 500});
    if (kind === "exr") fs.writeFileSync(at("back.exr"), bytes);
    const again = await open(bytes);
    assert.equal(again.channels, 3, kind);
    again.close();
  }
  await run("convert", at("back.exr"), at("back.burnish"));
  assert.deepEqual(fs.readFileSync(at("back.burnish")), fs.readFileSync(at("a.burnish")));

  // edited: brighter, tinted, with a Lambertian part
  const up = [0, 0, 1], plain = await model.evaluate(up, up);
  const edited = await model.edit({scale: [2, 1, 0.5], diffuse: 0.1});
  const changed = await edited.evaluate(up, up);
  for (const [c, factor] of [2, 1, 0.5].entries())
    assert.ok(Math.abs(changed[c] / (factor * plain[c] + 0.1 / Math.PI) - 1) < 1e-5);
  assert.ok((await edited.shader("glsl_es")).code.includes("burnish_brdf"));
  edited.close();

  // each lobe by its own hue, its colour that of what it reflects
  const {lobes, scales} = await model.info(), only = (l, hue) => model.edit({scale: scales.map((_, k) => [k === l ? 1 : 0]), hue});
  const albedo = async (l, hue) => {
    const lobe = await only(l, hue), found = await lobe.albedo([0.2, 0.6, 1]);
    lobe.close();
    return [0, 1, 2].map((c) => found[c] + found[3 + c] + found[6 + c]);
  };
  const third = scales.map((_, l) => (l === 0 ? 2 * Math.PI / 3 : 0)), turned = await model.edit({hue: third});
  const {scales: after} = await turned.info(), [was, is] = [await albedo(0, 0), await albedo(0, third)];
  assert.equal(lobes, after.length);
  assert.ok([0, 1, 2].every((c) => Math.abs(is[(c + 1) % 3] / was[c] - 1) < 0.1), `${was}, ${is}`);
  assert.deepEqual(after.slice(1), scales.slice(1));
  await assert.rejects(model.edit({hue: [1, 2, 3, 4, 5, 6, 7]}), /expected hues of/);
  turned.close();

  const {size, data: cells} = await model.volume({thetaH: 8, thetaD: 9, phiD: 10});
  assert.deepEqual(size, [8, 9, 10]);
  assert.equal(cells.length, 8 * 9 * 10 * 3);
  // the cell (3, 2, 4) by the definition of its place
  const [h, d, p] = [(3.5 / 8) ** 2 * Math.PI / 2, 2.5 / 9 * Math.PI / 2, 4.5 / 10 * 2 * Math.PI];
  const local = [Math.sin(d) * Math.cos(p), Math.sin(d) * Math.sin(p), Math.cos(d)];
  const wi = [Math.cos(h) * local[0] + Math.sin(h) * local[2], local[1], -Math.sin(h) * local[0] + Math.cos(h) * local[2]];
  const half = [Math.sin(h), 0, Math.cos(h)], dot = wi[0] * half[0] + wi[2] * half[2];
  const wo = wi.map((x, i) => 2 * dot * half[i] - x);
  const [value] = await model.evaluate(wi, wo);
  assert.ok(Math.abs(cells[3 * ((4 * 9 + 2) * 8 + 3)] / value - 1) < 1e-4);
  const pictures = await model.images(model, {size: 32});
  assert.equal(pictures.reference.length, 3);
  assert.deepEqual(pictures.reference, pictures.model);
  assert.equal(pictures.model[0].length, 32 * 32 * 3);
  assert.ok((await model.albedo([0, 0.5])).every((a) => a > 0 && a < 1));
  model.close();
});

test("OpenPBR is exported by its formulas, as `export` does", async (t) => {
  const spec = "openpbr:base_color=0.6/0.3/0.1,specular_roughness=0.3,coat_weight=1", kinds = {
    materialx: "mtlx", usda: "usda", three: "three.js", babylon: "babylon.js", html: "html",
    glsl: "glsl", glsl_es: "es.glsl", hlsl: "hlsl", slang: "slang", wgsl: "wgsl", msl: "metal", cpp: "h"};
  const material = await open(spec);
  t.after(() => material.close());
  await run("export", spec, ...Object.keys(kinds).flatMap((kind) => ["--to", kind]), "--name", "paint", "-o", at("openpbr"));
  for (const [kind, ending] of Object.entries(kinds)) {
    const files = await material.export(kind, {name: "paint"});
    const found = files.find(({name}) => name === `paint.${ending}`);
    assert.equal(Buffer.from(found.bytes).toString(), fs.readFileSync(path.join(at("openpbr"), `paint.${ending}`), "utf8"), kind);
  }
  assert.ok((await material.export("gltf", {name: "paint"})).some(({name}) => name === "paint.glb"));
  await assert.rejects(material.export("ktx2"), /expected/);
});

// Returns OpenPBR's inputs in a USD layer: numbers and lists of numbers by their names.
function inputsOf(usda) {
  const shader = usda.slice(usda.indexOf('def Shader "openpbr"')), found = {};
  for (const [, name, value] of shader.matchAll(/inputs:(\w+) = (\([^)]*\)|[-+.\de]+)$/gm))
    found[name] = value.startsWith("(") ? value.slice(1, -1).split(",").map(Number) : Number(value);
  return found;
}

test("The same paint has the same OpenPBR by fit, by export and by the package", async (t) => {
  const model = await open(bytesOf(at("a.burnish")), {name: "paint"});
  t.after(() => model.close());
  await run("fit", at("a.burnish"), "--to", "openpbr", "--alone", "-o", at("paint.json"));
  const {parameters} = JSON.parse(fs.readFileSync(at("paint.json"), "utf8"));
  await run("export", at("a.burnish"), "--to", "usda", "--name", "paint", "-o", at("exported"));
  const exported = inputsOf(fs.readFileSync(at("exported/paint.usda"), "utf8")), names = Object.keys(exported);
  assert.ok(names.length > 15 && names.every((name) => name in parameters), names.join());
  for (const name of names) assert.deepEqual(exported[name], parameters[name], name);
  const files = await model.export("usda", {name: "paint"}), {bytes} = files.find(({name}) => name === "paint.usda");
  const found = inputsOf(Buffer.from(bytes).toString());
  assert.deepEqual(Object.keys(found), names);
  // Floats of the processors differ by rounding, which least squares may magnify.
  for (const name of names)
    for (const [i, expected] of [exported[name]].flat().entries())
      assert.ok(Math.abs([found[name]].flat()[i] - expected) < 0.01, `${name}: ${found[name]} instead of ${exported[name]}`);
});

test("Memory of closed materials is used again", async () => {
  await run("convert", kSpec, at("whole.binary"));  // 35 MB
  const bytes = bytesOf(at("whole.binary")), keep = await open(kSpec), begin = performance.now();
  (await open(bytes, {name: "whole"})).close();
  console.log(`MERL of ${bytes.length} bytes opened in ${((performance.now() - begin) / 1000).toFixed(2)} s`);
  await keep.info();
  const once = memory();
  for (let i = 0; i < 4; ++i) (await open(bytes, {name: "whole"})).close();
  await keep.info();
  console.log(`${(once / 2 ** 20).toFixed(0)} MB by one of them, ${(memory() / 2 ** 20).toFixed(0)} MB by five`);
  assert.ok(once > bytes.length && memory() < once + bytes.length);
  keep.close();
  assert.equal(memory(), 0);
});
