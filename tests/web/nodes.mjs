// node nodes.mjs FOLDER NAME...: draws the node materials of NAME.three.js in Chromium, by WebGPURenderer's WebGL and,
// if Chromium has it, by its WebGPU. NAME.sphere.exr in FOLDER is our renderer's picture of the same sphere.
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import {chromium} from "playwright-core";
import {FloatType} from "three";
import {EXRLoader} from "three/examples/jsm/loaders/EXRLoader.js";

const [folder, ...names] = process.argv.slice(2);
const three = path.join(import.meta.dirname, "node_modules/three/build");
const addons = path.join(three, "../examples/jsm");
const kSide = 64, kSamples = 4;  // pixels of --size, and of each --samples along both axes

// The scene of `burnish render --mesh sphere --lights 2,3,4:20`, rows from the bottom. window.draw draws it, and what
// becomes of it in fog, in a shadow (the screen is beside the picture), under a white environment or a window in place
// of the lamp, and on the canvas with tone mapping.
const imports = {"three/webgpu": "/three.webgpu.js", "three": "/three.webgpu.js"};
const page = `<!DOCTYPE html><body><script type="importmap">${JSON.stringify({imports})}</script>
<script type="module">
import * as THREE from "three/webgpu";
import {RectAreaLightTexturesLib} from "/lights/RectAreaLightTexturesLib.js";
THREE.RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());
const n = ${kSamples}, small = ${kSide}, side = n * small, fov = 0.6;
const positions = [], tangents = [], indices = [], columns = 256, rows = 128;
for (let j = 0; j <= rows; ++j)
  for (let i = 0; i <= columns; ++i) {
    const u = 2 * Math.PI * i / columns, v = Math.PI * j / rows, at = j * (columns + 1) + i, up = at + columns + 1;
    positions.push(Math.sin(v) * Math.sin(u), -Math.cos(v), Math.sin(v) * Math.cos(u));
    tangents.push(Math.cos(u), 0, -Math.sin(u), 1);
    if (i < columns && j < rows) indices.push(at, at + 1, up + 1, at, up + 1, up);
  }
const renderer = new THREE.WebGPURenderer({forceWebGL: !location.search.includes("webgpu")});
renderer.shadowMap.enabled = true;
await renderer.init();
const target = new THREE.RenderTarget(side, side, {type: THREE.FloatType});
renderer.setRenderTarget(target);
const camera = new THREE.PerspectiveCamera(fov * 180 / Math.PI, 1, 0.5, 10);
camera.position.z = 1.04 / Math.sin(fov / 2);

// Rows from the bottom, averaged over each pixel's samples.
async function picture(scene) {
  await renderer.renderAsync(scene, camera);
  if (!renderer.getRenderTarget()) return [];
  const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, side, side);
  const sum = new Float32Array(3 * small * small), down = renderer.backend.isWebGPUBackend;
  for (let y = 0; y < side; ++y)
    for (let x = 0; x < side; ++x)
      for (let c = 0; c < 3; ++c)
        sum[3 * (Math.floor((down ? side - 1 - y : y) / n) * small + Math.floor(x / n)) + c] +=
          pixels[4 * (y * side + x) + c] / n ** 2;
  return Array.from(sum);
}

window.draw = async (name) => {
  const {createNodeMaterial} = await import("/" + name + ".three.js"), shape = new THREE.BufferGeometry();
  const attributes = [["position", positions, 3], ["normal", positions, 3], ["tangent", tangents, 4]];
  for (const [called, values, width] of attributes)
    shape.setAttribute(called, new THREE.BufferAttribute(new Float32Array(values), width));
  shape.setIndex(indices);
  const made = (change, lamp = new THREE.PointLight(0xffffff, 20)) => {
    const scene = new THREE.Scene(), ball = new THREE.Mesh(shape, createNodeMaterial(THREE));
    lamp.position.set(2, 3, 4);
    lamp.lookAt(0, 0, 0);
    scene.add(lamp, ball);
    change?.(scene, lamp, ball);
    return picture(scene);
  };
  const drawn = {backend: renderer.backend.isWebGPUBackend ? "WebGPU" : "WebGL", lit: await made()};
  drawn.fog = await made((scene) => { scene.fog = new THREE.Fog(0x0000ff, 0.1, 0.2); });
  drawn.spot = await made(null, new THREE.SpotLight(0xffffff, 20));
  drawn.shadow = await made((scene, lamp, ball) => {
    lamp.castShadow = ball.receiveShadow = true;
    const black = new THREE.MeshBasicNodeMaterial({side: THREE.DoubleSide});
    const screen = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), black);
    screen.position.copy(lamp.position).multiplyScalar(0.8);
    screen.lookAt(0, 0, 0);
    screen.castShadow = true;
    scene.add(screen);
  }, new THREE.SpotLight(0xffffff, 20));
  const white = new THREE.DataTexture(new Float32Array(4 * 64 * 32).fill(1), 64, 32, THREE.RGBAFormat, THREE.FloatType);
  white.mapping = THREE.EquirectangularReflectionMapping;
  white.needsUpdate = true;
  drawn.environment = await made((scene, lamp) => {
    scene.environment = white;
    scene.remove(lamp);
  });
  drawn.window = await made(null, new THREE.RectAreaLight(0xffffff, 10, 2, 2));

  // On the canvas, tone mapping makes one eighth of the light darker than all of it.
  renderer.setRenderTarget(null);
  renderer.setSize(small, small, false);
  renderer.toneMapping = THREE.LinearToneMapping;
  for (const exposure of [1, 1 / 8]) {
    renderer.toneMappingExposure = exposure;
    await made(null);
    const copy = new OffscreenCanvas(small, small).getContext("2d");
    copy.drawImage(renderer.domElement, 0, 0);
    drawn["shown" + exposure] = Array.from(copy.getImageData(0, 0, small, small).data).filter((_, i) => i % 4 < 3);
  }
  renderer.toneMapping = THREE.NoToneMapping;
  renderer.setRenderTarget(target);
  return drawn;
};
window.ready = true;
</script></body>`;

const server = http.createServer((request, response) => {
  const place = new URL(request.url, "http://x").pathname;
  const from = place.startsWith("/three.") ? three : place.startsWith("/lights/") ? addons : folder;
  const file = path.join(from, place);
  response.setHeader("content-type", place === "/" ? "text/html" : "text/javascript");
  if (place === "/") return response.end(page);
  if (!fs.existsSync(file)) return response.writeHead(404).end();
  response.end(fs.readFileSync(file));
});
await new Promise((done) => server.listen(0, done));
const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: [
  "--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan",
  "--use-vulkan=swiftshader", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-vulkan-surface"]});

const mean = (picture, channel) =>
  picture.reduce((sum, value, i) => sum + (i % 3 === channel ? value : 0), 0) / kSide ** 2;
for (const backend of ["webgl", "webgpu"]) {
  const tab = await browser.newPage(), complaints = [];
  tab.on("pageerror", (error) => complaints.push(error.message));
  tab.on("console", (said) => {
    if (said.type() === "error" && !said.text().includes("404")) complaints.push(said.text());
  });
  await tab.goto(`http://localhost:${server.address().port}/?${backend}`);
  await tab.waitForFunction(() => window.ready, null, {timeout: 120000})
    .catch((error) => { throw new Error(`${complaints} ${error}`); });
  for (const name of names) {
    const drawn = await tab.evaluate((one) => window.draw(one), name);
    if (backend === "webgpu" && drawn.backend !== "WebGPU") {
      console.log("web: Chromium has no WebGPU here, so node materials were drawn by WebGL alone");
      break;
    }
    const truth = new EXRLoader().setDataType(FloatType)
      .parse(new Uint8Array(fs.readFileSync(path.join(folder, `${name}.sphere.exr`))).buffer);
    const lit = truth.data.filter((value, i) => i % 4 < 3 && value > 0).sort();
    const exposure = 1 / lit[Math.floor(0.97 * lit.length)];
    const level = (value) => Math.min(Math.max(exposure * value, 0), 1);
    let error = 0;
    for (let i = 0; i < kSide * kSide; ++i)
      for (let c = 0; c < 3; ++c) error += (level(drawn.lit[3 * i + c]) - level(truth.data[4 * i + c])) ** 2;
    const psnr = -10 * Math.log10(error / (3 * kSide * kSide));
    console.log(`web: ${name} as nodes by ${drawn.backend}: ${psnr.toFixed(2)} dB`);
    assert.deepEqual(complaints, []);
    assert.ok(psnr >= 40, `${name} by ${drawn.backend}: expected 40 dB, found ${psnr}`);
    const pictures = ["lit", "fog", "spot", "shadow", "environment", "window", "shown1", "shown0.125"];
    const means = Object.fromEntries(pictures.map((key) =>
      [key, [0, 1, 2].map((channel) => mean(drawn[key], channel))]));
    const said = JSON.stringify(means);
    assert.ok(means.lit[0] > 0.01, said);
    assert.ok(means.fog[0] < 1e-3 && means.fog[2] > 0.5, said);
    assert.ok(Math.abs(means.spot[0] / means.lit[0] - 1) < 1e-3 && means.shadow[0] < 0.05 * means.spot[0], said);
    assert.ok(means.window[0] > 0.01, said);
    // Headless, Chromium shows nothing of WebGPU on a canvas.
    if (drawn.backend === "WebGL")
      assert.ok(means.shown1[0] > 10 && means["shown0.125"][0] < 0.6 * means.shown1[0], said);
    assert.ok(means.environment[0] > 0.05 && means.environment[0] < 1, said);
  }
  await tab.close();
}
await browser.close();
server.close();
