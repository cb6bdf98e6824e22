"use strict";
const model = MODEL;
const find = (selector) => document.querySelector(selector);
const canvas = find("canvas");
const gl = canvas.getContext("webgl2", {antialias: true, preserveDrawingBuffer: true});
if (!gl) throw new Error("expected WebGL2, found none");
find("b").textContent = model.name;
find("code").textContent = find("code").title = model.expression;

function shader(type, text) {
  const s = gl.createShader(type);
  gl.shaderSource(s, text);
  gl.compileShader(s);
  if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s));
  return s;
}
const program = gl.createProgram();
gl.attachShader(program, shader(gl.VERTEX_SHADER, `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
uniform mat3 turn;
uniform vec2 zoom;
out vec3 n, t;
out vec2 at;  // of a surface, v downwards
void main() {
  at = vec2(0.5, 0.5) + vec2(position.x, -position.y) / 1.7;
  vec3 p = turn * position;
  n = turn * normal;
  t = turn * tangent;
  gl_Position = vec4(zoom * p.xy, -0.5 * p.z, 1);
}`));
const around = model.environment;
gl.attachShader(program, shader(gl.FRAGMENT_SHADER, "#version 300 es\n" + model.shader + (around?.shader ?? "") + `
in vec3 n, t;
in vec2 at;
uniform vec3 light;
uniform vec2 exposures;
out vec4 color;
void main() {
  vec3 normal = normalize(n), tangent = normalize(t - dot(t, normal) * normal), view = vec3(0, 0, 1);
  vec3 facing = normal;
  ${model.maps ? `
  vec2 across = dFdx(at), down = dFdy(at);
  burnish_${model.name}_place place = burnish_${model.name}_at(
      at.x, at.y, burnish_${model.name}_lod(across.x, across.y, down.x, down.y));` : ""}
  ${model.framed ? "facing = mat3(tangent, cross(normal, tangent), normal) * place.n;" : ""}
  vec3 sum = exposures.x * max(dot(facing, light), 0.0) *
             burnish_${model.name}_world(normal, tangent, light, view${model.maps ? ", place" : ""});
  ${around ? `if (exposures.y > 0.0) sum += exposures.y * ${around.call};` : ""}
  color = vec4(pow(min(sum, 1.0), vec3(1.0 / 2.2)), 1);
}`));
gl.linkProgram(program);
if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
gl.useProgram(program);
const uniform = (name) => gl.getUniformLocation(program, name);

const decode = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
[...model.textures, ...(around?.textures ?? [])].forEach((texture, unit) => {
  const kind = texture.depth ? gl.TEXTURE_3D : gl.TEXTURE_2D, texels = new Uint16Array(decode(texture.rgba16f));
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(kind, gl.createTexture());
  if (texture.depth)
    gl.texImage3D(kind, 0, gl.RGBA16F, texture.width, texture.height, texture.depth, 0, gl.RGBA, gl.HALF_FLOAT, texels);
  else gl.texImage2D(kind, 0, gl.RGBA16F, texture.width, texture.height, 0, gl.RGBA, gl.HALF_FLOAT, texels);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
    gl.texParameteri(kind, side, gl.CLAMP_TO_EDGE);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(kind, filter, gl.LINEAR);
  gl.uniform1i(uniform(texture.name), unit);
});
// Maps of a surface with their levels.
(model.maps ?? []).forEach(({name, width, height, half, levels}, k) => {
  const unit = model.textures.length + k;
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  levels.map(decode).forEach((texels, level) => {
    const size = [Math.max(width >> level, 1), Math.max(height >> level, 1)];
    if (half) gl.texImage2D(gl.TEXTURE_2D, level, gl.RGBA16F, ...size, 0, gl.RGBA, gl.HALF_FLOAT, new Uint16Array(texels));
    else gl.texImage2D(gl.TEXTURE_2D, level, gl.RGBA8, ...size, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(texels));
  });
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.uniform1i(uniform(name), unit);
});
if (model.maps) {
  find("select").prepend(new Option("plane"));
  find("select").selectedIndex = 0;
}
for (const box of ["#lamp", "#around"]) find(box).parentElement.hidden = !around;

const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const unit = (a) => { const l = Math.hypot(...a); return a.map((x) => x / l); };

// A grid of vertices over [0, 1]^2: at(u, v) gives [position, normal, tangent].
function grid(columns, rows, at) {
  const vertices = [], indices = [];
  for (let i = 0; i <= columns; ++i)
    for (let j = 0; j <= rows; ++j) vertices.push(...at(i / columns, j / rows).flat());
  for (let i = 0; i < columns; ++i)
    for (let j = 0; j < rows; ++j) {
      const a = i * (rows + 1) + j, b = a + rows + 1;
      indices.push(a, b, a + 1, a + 1, b, b + 1);
    }
  return mesh(vertices, indices);
}
function mesh(vertices, indices) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.STATIC_DRAW);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(indices), gl.STATIC_DRAW);
  for (let k = 0; k < 3; ++k) {
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 36, 12 * k);
  }
  return {array, count: indices.length};
}
const knot = (u) => {
  const a = 4 * Math.PI * u, b = 6 * Math.PI * u, r = 0.27 * (2 + Math.cos(b));
  return [r * Math.cos(a), r * Math.sin(a), 0.27 * Math.sin(b)];
};
const shapes = {
  teapot: mesh(Array.from(new Int16Array(decode(model.teapot.vertices)), (x) => x / 32767),
               new Uint16Array(decode(model.teapot.indices))),
  "torus knot": grid(640, 48, (u, v) => {
    const p = knot(u), q = knot(u + 1e-4), along = unit(add(q, p, -1));
    const side = unit(cross(along, add(p, q))), up = cross(side, along);
    const normal = add(up.map((x) => x * Math.cos(2 * Math.PI * v)), side, Math.sin(2 * Math.PI * v));
    return [add(p, normal, 0.14), normal, along];
  }),
  plane: grid(1, 1, (u, v) => [[1.7 * u - 0.85, 1.7 * v - 0.85, 0], [0, 0, 1], [1, 0, 0]]),
  sphere: grid(96, 96, (u, v) => {
    const phi = 2 * Math.PI * u, theta = 1e-4 + (Math.PI - 2e-4) * v;
    const normal = [Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi)];
    return [normal.map((x) => 0.85 * x), normal, [Math.cos(phi), 0, -Math.sin(phi)]];
  }),
};

let light = unit([0.4, 0.5, 0.8]), yaw = 0.3, pitch = 0.35;
function draw() {
  const ratio = window.devicePixelRatio;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(0.09, 0.094, 0.102, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const c = Math.cos(yaw), s = Math.sin(yaw), d = Math.cos(pitch), e = Math.sin(pitch);
  gl.uniformMatrix3fv(uniform("turn"), false, [c, s * e, -s * d, 0, d, e, s, -c * e, c * d]);
  const least = Math.min(canvas.width, canvas.height);
  gl.uniform2f(uniform("zoom"), least / canvas.width, least / canvas.height);
  gl.uniform3fv(uniform("light"), light);
  const exposure = 2 ** find("#exposure").value;
  gl.uniform2f(uniform("exposures"), find("#lamp").checked * exposure, find("#around").checked * exposure);
  const shape = shapes[find("select").value];
  gl.bindVertexArray(shape.array);
  gl.drawElements(gl.TRIANGLES, shape.count, gl.UNSIGNED_SHORT, 0);
}
// The exposure that takes the brightest 3 % of the object's pixels to white.
function expose() {
  let low = -12, high = 12;
  for (let i = 0; i < 10; ++i) {
    find("#exposure").value = (low + high) / 2;
    draw();
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let white = 0;
    for (let p = 0; p < pixels.length; p += 4) white += Math.max(pixels[p], pixels[p + 1], pixels[p + 2]) === 255;
    if (white > 0.03 * 0.4 * Math.min(canvas.width, canvas.height) ** 2) high = (low + high) / 2;
    else low = (low + high) / 2;
  }
}

canvas.addEventListener("pointermove", (event) => {
  if (!event.buttons) return;
  if (event.shiftKey) {
    yaw += event.movementX / 150;
    pitch += event.movementY / 150;
  } else {
    const half = 0.5 * Math.min(canvas.clientWidth, canvas.clientHeight);
    let x = (event.offsetX - 0.5 * canvas.clientWidth) / half, y = (0.5 * canvas.clientHeight - event.offsetY) / half;
    const r = Math.max(Math.hypot(x, y) / 0.98, 1);
    light = [x / r, y / r, Math.sqrt(1 - (x * x + y * y) / (r * r))];
  }
  draw();
});
for (const control of ["select", "#exposure", "#lamp", "#around"]) find(control).addEventListener("input", draw);
window.addEventListener("resize", draw);
expose();
draw();
