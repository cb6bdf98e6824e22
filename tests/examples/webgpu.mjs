// Opens the page of a folder in Chromium and prints what one pixel shows, as numbers from 0 to 1, or "no WebGPU":
//   node webgpu.mjs FOLDER X Y STRENGTH       from the folder that has playwright-core
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import {chromium} from "playwright-core";

const [folder, ...light] = process.argv.slice(2);
const server = http.createServer((request, response) => {
  const file = path.join(folder, new URL(request.url, "http://x").pathname.replace(/\/$/, "/index.html"));
  if (!fs.existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, {"content-type": file.endsWith(".html") ? "text/html" : "application/octet-stream"});
  response.end(fs.readFileSync(file));
});
await new Promise((done) => server.listen(0, done));
const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox",
  "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
  "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-vulkan-surface"]});
const page = await browser.newPage();
const complaints = [];
page.on("pageerror", (error) => complaints.push(error.message));
await page.goto(`http://localhost:${server.address().port}/`);
await page.waitForFunction(() => window.burnish || document.querySelector("p").textContent, null, {timeout: 60000});
const told = await page.textContent("p");
if (told) {
  console.log(told.includes("no WebGPU") ? "no WebGPU" : told);
} else {
  // The pixel in the middle, where the normal looks at the viewer, from a texture that can be read.
  console.log(...await page.evaluate(async (numbers) => {
    const {device, draw, format} = window.burnish;
    const texture = device.createTexture({size: [512, 512], format, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC});
    draw(...numbers, texture.createView());
    const buffer = device.createBuffer({size: 512 * 512 * 4, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ});
    const commands = device.createCommandEncoder();
    commands.copyTextureToBuffer({texture}, {buffer, bytesPerRow: 2048}, [512, 512]);
    device.queue.submit([commands.finish()]);
    await buffer.mapAsync(GPUMapMode.READ);
    const texels = new Uint8Array(buffer.getMappedRange());
    const [r, g, b] = texels.subarray(4 * (256 * 512 + 256));
    return (format.startsWith("bgra") ? [b, g, r] : [r, g, b]).map((byte) => byte / 255);
  }, light.map(Number)));
}
await browser.close();
server.close();
if (complaints.length) console.error(complaints.join("\n"));
process.exit(complaints.length ? 1 : 0);
