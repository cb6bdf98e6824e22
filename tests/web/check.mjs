// node check.mjs FOLDER NAME F: opens what `burnish export ... --name NAME -o FOLDER` wrote in the programs it was written
// for. F is f_r of the first channel at the normal. NAME.sphere.exr and openpbr.sphere.exr in FOLDER are our renderer's
// pictures of the sphere that spheres() draws.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {pathToFileURL} from "node:url";
import validator from "gltf-validator";
import {read as readKtx2} from "ktx-parse";
import * as THREE from "three";
import {EXRLoader} from "three/examples/jsm/loaders/EXRLoader.js";
import {GLTFLoader} from "three/examples/jsm/loaders/GLTFLoader.js";
import {KTX2Loader} from "three/examples/jsm/loaders/KTX2Loader.js";

const [folder, name, value] = process.argv.slice(2);
const bytes = (file) => new Uint8Array(fs.readFileSync(path.join(folder, file)));
const manifest = JSON.parse(fs.readFileSync(path.join(folder, `${name}.json`)));

// Textures: ktx-parse and the loaders of three.js find the tables' texels, times a power of two.
const tableNames = manifest.images.map((image) => image.table);
for (const texture of manifest.textures) {
  const container = readKtx2(bytes(texture.file));
  assert.deepEqual([container.pixelWidth, container.pixelHeight, container.pixelDepth],
                   [texture.width, texture.height, texture.depth ?? 0]);
  assert.equal(container.levels.length, texture.levels ?? 1);
  const loader = new KTX2Loader();
  loader.workerConfig = {};  // no GPU to ask: the texels are not compressed for one
  const map = await new Promise((done, failed) => loader.parse(bytes(texture.file).buffer, done, failed));
  const texels = map.mipmaps?.[0]?.data ?? map.image.data;
  for (const {table, first, nodes, exponent} of texture.tables) {
    const file = manifest.images[tableNames.indexOf(table)].file, [width, height, depth] = nodes;
    const image = new EXRLoader().setDataType(THREE.FloatType).parse(bytes(file).buffer);
    assert.deepEqual([image.width, image.height], [width, height * depth]);
    let largest = 0;
    for (let row = 0; row < height * depth; ++row)
      for (let x = 0; x < width; ++x) {
        const z = first[2] + Math.floor(row / height), y = first[1] + row % height;
        const at = 4 * ((z * texture.height + y) * texture.width + first[0] + x);
        const seen = 4 * ((height * depth - 1 - row) * width + x);  // EXRLoader turns images upside down
        for (let c = 0; c < 3; ++c) {
          const half = THREE.DataUtils.fromHalfFloat(texels[at + c]) / 2 ** exponent;
          assert.equal(half, image.data[seen + c]);
          largest = Math.max(largest, half);
        }
      }
    assert.equal(largest, 1);
  }
}

// Tables with their levels.
for (const table of manifest.mips) {
  const container = readKtx2(bytes(table.file));
  assert.deepEqual([container.pixelWidth, container.pixelHeight, container.levels.length],
                   [table.width, table.height, table.levels]);
}

// Cube maps with their levels.
for (const cube of manifest.cube_maps) {
  const container = readKtx2(bytes(cube.file));
  assert.deepEqual([container.faceCount, container.pixelWidth, container.levels.length], [6, cube.side, cube.levels]);
}

// Light from all around: a 3-D texture and tables.
assert.ok(manifest.light.textures.some((texture) => texture.depth > 1));
for (const texture of manifest.light.textures) {
  const container = readKtx2(bytes(texture.file));
  assert.deepEqual([container.pixelWidth, container.pixelHeight, container.pixelDepth],
                   [texture.width, texture.height, texture.depth]);
  assert.equal(container.levels[0].uncompressedByteLength,
               texture.width * texture.height * Math.max(texture.depth, 1) * (container.vkFormat === 97 ? 8 : 2));
}

// glTF: the validator of Khronos finds no fault, and three.js the material.
const report = await validator.validateBytes(bytes(manifest.gltf));
assert.equal(report.issues.numErrors + report.issues.numWarnings, 0, JSON.stringify(report.issues.messages));
globalThis.self ??= globalThis;
const gltf = await new GLTFLoader().parseAsync(bytes(manifest.gltf).buffer, "");
const mesh = gltf.scene.getObjectByProperty("isMesh", true), shown = manifest.gltf_material;
assert.equal(mesh.material.roughness, shown.pbrMetallicRoughness.roughnessFactor);
assert.equal(mesh.material.metalness, shown.pbrMetallicRoughness.metallicFactor);
assert.equal(mesh.material.anisotropy ?? 0, shown.extensions?.KHR_materials_anisotropy?.anisotropyStrength ?? 0);
assert.ok(mesh.geometry.attributes.tangent.count > 1000);
assert.ok(mesh.material.userData.gltfExtensions.BURNISH_materials_factored.lobes.length >= 1);

// A surface: its textures are pictures of its size.
{
  const wall = new Uint8Array(fs.readFileSync(path.join(folder, "flat.glb")));
  const said = await validator.validateBytes(wall);
  assert.equal(said.issues.numErrors + said.issues.numWarnings, 0, JSON.stringify(said.issues.messages));
  const {width, height} = JSON.parse(fs.readFileSync(path.join(folder, "flat.json"))).surface;
  const pictures = said.info.resources.filter(({mimeType}) => mimeType === "image/png");
  assert.ok(pictures.length >= 2);
  for (const {image} of pictures) assert.deepEqual([image.width, image.height], [width, height]);
}

// OpenPBR as glTF: the validator knows its extensions, and three.js makes a physical material of them.
{
  const coated = new Uint8Array(fs.readFileSync(path.join(folder, "openpbr.glb")));
  const said = await validator.validateBytes(coated);
  assert.equal(said.issues.numErrors + said.issues.numWarnings, 0, JSON.stringify(said.issues.messages));
  const {scene} = await new GLTFLoader().parseAsync(coated.buffer, "");
  const {material} = scene.getObjectByProperty("isMesh", true);
  assert.ok(material.isMeshPhysicalMaterial);
  const {KHR_materials_clearcoat: coat, KHR_materials_sheen: sheen, KHR_materials_iridescence: film} =
    JSON.parse(fs.readFileSync(path.join(folder, "openpbr.json"))).gltf.material.extensions;
  assert.equal(material.clearcoat, coat?.clearcoatFactor ?? 0);
  assert.equal(material.sheenRoughness, sheen?.sheenRoughnessFactor ?? 0);
  assert.equal(material.iridescence, film?.iridescenceFactor ?? 0);
  assert.ok(material.anisotropy > 0);
}

// three.js and Babylon.js: a plane seen and lit along its normal, drawn into floats by Chromium.
const {createMaterial} = await import(pathToFileURL(path.resolve(folder, manifest.three)));
assert.equal(Object.values(createMaterial(THREE).uniforms).filter((u) => u.value?.isTexture).length,
             manifest.textures.length);
const surfaceValue = Number(fs.readFileSync(path.join(folder, "flat.txt"), "utf8"));
const page = path.resolve(folder, "modules.html");
const modules = (file) => pathToFileURL(path.resolve(import.meta.dirname, process.env.NODE_FOLDER, file));
fs.writeFileSync(page, `<!DOCTYPE html><body><script src="${modules("babylonjs/babylon.js")}"></script><script type="module">
import * as THREE from "${modules("three/build/three.module.js")}";
import {createMaterial} from "./${manifest.three}";
import {createMaterial as createSurface} from "./flat.three.js";
import {createMaterial as createBabylon} from "./${manifest.babylon}";
let errors = 0;
console.error = (...text) => { ++errors; document.body.dataset.said = text.join(" "); };
const renderer = new THREE.WebGLRenderer(), target = new THREE.WebGLRenderTarget(8, 8, {type: THREE.FloatType});
const scene = new THREE.Scene(), camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
camera.position.z = 2;
const light = new THREE.DirectionalLight(0xffffff, 2);
light.position.set(0, 0, 1);
scene.add(light, new THREE.Mesh(new THREE.PlaneGeometry(2, 2), createMaterial(THREE)));
renderer.setRenderTarget(target);
renderer.render(scene, camera);
const pixel = new Float32Array(4);
renderer.readRenderTargetPixels(target, 4, 4, 1, 1, pixel);

scene.children[1].material = createSurface(THREE);
renderer.render(scene, camera);
const onSurface = new Float32Array(4);
renderer.readRenderTargetPixels(target, 4, 3, 1, 1, onSurface);

const canvas = document.createElement("canvas"), engine = new BABYLON.Engine(canvas), world = new BABYLON.Scene(engine);
const eye = new BABYLON.FreeCamera("eye", new BABYLON.Vector3(0, 0, -2), world), at = new BABYLON.Vector3(0, 0, -4);
const sun = new BABYLON.DirectionalLight("sun", new BABYLON.Vector3(0, 0, 1), world);
sun.intensity = 1;
new BABYLON.PointLight("lamp", at, world).intensity = 16;
const plane = BABYLON.MeshBuilder.CreatePlane("plane", {size: 2}, world);  // left-handed: it faces -z
plane.material = createBabylon(BABYLON, world, {linear: true});
const drawn = new BABYLON.RenderTargetTexture("drawn", 9, world, false, true, BABYLON.Constants.TEXTURETYPE_FLOAT);
Object.assign(drawn, {activeCamera: eye, renderList: [plane]});
await world.whenReadyAsync();
while (!plane.material.isReady(plane)) await new Promise((next) => setTimeout(next, 20));
drawn.render();
const other = await drawn.readPixels();
document.body.dataset.result = [pixel[0], other[4 * (4 * 9 + 4)], errors, onSurface[0]].join(" ");
</script></body>`);
const dom = resultOf(page), result = dom.match(/([^ ]+) ([^ ]+) ([^ ]+) (.+)/);
assert.equal(Number(result[3]), 0, dom);
for (const found of [result[1], result[2]])
  assert.ok(Math.abs(found / (2 * value) - 1) < 2e-3, `expected ${2 * value}, found ${found}`);
assert.ok(Math.abs(result[4] / (2 * surfaceValue) - 1) < 5e-3, `surface: expected ${2 * surfaceValue}, found ${result[4]}`);
// The same sphere in both programs and by our renderer, of a factored model and of OpenPBR.
const kSide = 64, kSamples = 4;  // pixels of --size, and of each --samples along both axes
for (const shown of [name, "openpbr"]) {
  const truth = new EXRLoader().setDataType(THREE.FloatType).parse(bytes(`${shown}.sphere.exr`).buffer);
  assert.deepEqual([truth.width, truth.height], [kSide, kSide]);
  const lit = truth.data.filter((value, i) => i % 4 < 3 && value > 0).sort();
  const exposure = 1 / lit[Math.floor(0.97 * lit.length)];
  const level = (value) => Math.min(Math.max(exposure * value, 0), 1);
  const pictures = spheres(shown);
  for (const program of ["three.js", "Babylon.js"]) {
    let error = 0;
    for (let i = 0; i < kSide * kSide; ++i)
      for (let c = 0; c < 3; ++c) error += (level(pictures[program][3 * i + c]) - level(truth.data[4 * i + c])) ** 2;
    const psnr = -10 * Math.log10(error / (3 * kSide * kSide));
    console.log(`web: ${shown} in ${program}: ${psnr.toFixed(2)} dB`);
    assert.ok(psnr >= 40, `${shown} in ${program}: expected 40 dB, found ${psnr}`);
  }
}

// Linear floats of SHOWN.three.js and SHOWN.babylon.js in Chromium, rows from the bottom: the scene of
// `burnish render --mesh sphere --lights 2,3,4:20`.
function spheres(shown) {
  const place = path.resolve(folder, "spheres.html");
  fs.writeFileSync(place, `<!DOCTYPE html><body><script src="${modules("babylonjs/babylon.js")}"></script><script type="module">
import * as THREE from "${modules("three/build/three.module.js")}";
import {createMaterial as createThree} from "./${shown}.three.js";
import {createMaterial as createBabylon} from "./${shown}.babylon.js";
const n = ${kSamples}, small = ${kSide}, side = n * small, fov = 0.6, far = 1.04 / Math.sin(fov / 2);
const lamp = [2, 3, 4], intensity = 20;
const positions = [], tangents = [], indices = [], columns = 256, rows = 128;
for (let j = 0; j <= rows; ++j)
  for (let i = 0; i <= columns; ++i) {
    const u = 2 * Math.PI * i / columns, v = Math.PI * j / rows, at = j * (columns + 1) + i, up = at + columns + 1;
    positions.push(Math.sin(v) * Math.sin(u), -Math.cos(v), Math.sin(v) * Math.cos(u));
    tangents.push(Math.cos(u), 0, -Math.sin(u), 1);
    if (i < columns && j < rows) indices.push(at, at + 1, up + 1, at, up + 1, up);
  }
const averaged = (pixels) => {
  const sum = new Float32Array(3 * small * small);
  for (let y = 0; y < side; ++y)
    for (let x = 0; x < side; ++x)
      for (let c = 0; c < 3; ++c)
        sum[3 * (Math.floor(y / n) * small + Math.floor(x / n)) + c] += pixels[4 * (y * side + x) + c] / n ** 2;
  return Array.from(sum);
};

const renderer = new THREE.WebGLRenderer(), target = new THREE.WebGLRenderTarget(side, side, {type: THREE.FloatType});
const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(fov * 180 / Math.PI, 1, 0.5, 10);
camera.position.z = far;
const light = new THREE.PointLight(0xffffff, intensity), shape = new THREE.BufferGeometry();
light.position.set(...lamp);
for (const [called, values, width] of [["position", positions, 3], ["normal", positions, 3], ["tangent", tangents, 4]])
  shape.setAttribute(called, new THREE.BufferAttribute(new Float32Array(values), width));
shape.setIndex(indices);
scene.add(light, new THREE.Mesh(shape, createThree(THREE)));
renderer.setRenderTarget(target);
renderer.render(scene, camera);
const pixels = new Float32Array(4 * side * side);
renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);

// the canvas has the camera's shape
const square = Object.assign(document.createElement("canvas"), {width: small, height: small});
const engine = new BABYLON.Engine(square), world = new BABYLON.Scene(engine);
world.useRightHandedSystem = true;
world.clearColor = new BABYLON.Color4(0, 0, 0, 0);
const eye = new BABYLON.FreeCamera("eye", new BABYLON.Vector3(0, 0, far), world);
eye.setTarget(BABYLON.Vector3.Zero());
Object.assign(eye, {fov, minZ: 0.5, maxZ: 10});
new BABYLON.PointLight("lamp", new BABYLON.Vector3(...lamp), world).intensity = intensity;
const ball = new BABYLON.Mesh("ball", world), data = new BABYLON.VertexData();
Object.assign(data, {positions, normals: positions, tangents, indices});
data.applyToMesh(ball);
ball.material = createBabylon(BABYLON, world, {linear: true});
ball.material.backFaceCulling = false;
const drawn = new BABYLON.RenderTargetTexture("drawn", side, world, false, true, BABYLON.Constants.TEXTURETYPE_FLOAT);
Object.assign(drawn, {clearColor: world.clearColor, activeCamera: eye, renderList: [ball]});
await world.whenReadyAsync();
while (!ball.material.isReady(ball)) await new Promise((next) => setTimeout(next, 20));
drawn.render();
const drawings = {"three.js": averaged(pixels), "Babylon.js": averaged(await drawn.readPixels())};
document.body.dataset.result = JSON.stringify(drawings);
</script></body>`);
  return JSON.parse(resultOf(place).replaceAll("&quot;", '"'));
}

// What a page leaves in data-result of its body.
function resultOf(file) {
  const seen = execFileSync("timeout", ["300", "chromium", "--headless", "--no-sandbox", "--use-gl=angle",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--allow-file-access-from-files",
    `--user-data-dir=${path.resolve(folder, "profile")}`, "--virtual-time-budget=60000", "--dump-dom",
    pathToFileURL(file).href], {stdio: ["ignore", "pipe", "ignore"], maxBuffer: 2 ** 26}).toString();
  const found = seen.match(/data-result="([^"]+)"/);
  assert.ok(found, seen);
  return found[1];
}

console.log(`web: ${manifest.textures.length} KTX2, EXR, glTF, three.js and Babylon.js exports open elsewhere`);
