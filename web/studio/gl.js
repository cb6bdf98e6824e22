// A few functions for WebGL2: programs, textures, targets.

export function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
    gl.deleteShader(shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const places = new Map();
  const at = (name) => {
    if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name));
    return places.get(name);
  };
  return {handle: made, at};
}

export function mesh(gl, {vertices, indices}) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.STATIC_DRAW);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(indices), gl.STATIC_DRAW);
  for (let k = 0; k < 3; ++k) {
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 36, 12 * k);
  }
  gl.bindVertexArray(null);
  return {array, count: indices.length};
}

// Makes a filtered texture, with a depth a 3-D one. `repeat` names the axes that repeat, of "s", "t", "r".
export function texture(gl, {width, height, depth = 0, internal, format, type, data, repeat = "", filter = gl.LINEAR}) {
  const kind = depth ? gl.TEXTURE_3D : gl.TEXTURE_2D, handle = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(kind, handle);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  if (depth) gl.texImage3D(kind, 0, internal, width, height, depth, 0, format, type, data);
  else gl.texImage2D(kind, 0, internal, width, height, 0, format, type, data);
  for (const [name, axis] of [["s", gl.TEXTURE_WRAP_S], ["t", gl.TEXTURE_WRAP_T], ["r", gl.TEXTURE_WRAP_R]])
    gl.texParameteri(kind, axis, repeat.includes(name) ? gl.REPEAT : gl.CLAMP_TO_EDGE);
  for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(kind, which, filter);
  gl.bindTexture(kind, null);
  return {handle, kind};
}

// Makes a map of a surface with its levels; it repeats.
export function mapTexture(gl, {width, height, levels, gl: {internalFormat, format, type}}) {
  const handle = gl.createTexture(), kind = gl.TEXTURE_2D;
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(kind, handle);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  levels.forEach((texels, level) =>
    gl.texImage2D(kind, level, gl[internalFormat], Math.max(width >> level, 1), Math.max(height >> level, 1), 0, gl[format], gl[type], texels));
  gl.texParameteri(kind, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(kind, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  gl.bindTexture(kind, null);
  return {handle, kind};
}

// Makes a texture to draw into, with `deep` also a depth buffer.
export function target(gl, width, height, deep) {
  const color = texture(gl, {width, height, internal: gl.RGBA32F, format: gl.RGBA, type: gl.FLOAT, data: null, filter: gl.NEAREST});
  const frame = gl.createFramebuffer(), depth = deep ? gl.createRenderbuffer() : null;
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, color.handle, 0);
  if (depth) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }
  if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) throw new Error("expected a GPU that draws into float textures, found another");
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT);
  const free = () => {
    gl.deleteFramebuffer(frame);
    gl.deleteTexture(color.handle);
    if (depth) gl.deleteRenderbuffer(depth);
  };
  return {frame, color, width, height, free};
}

export function bind(gl, unit, {handle, kind}) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(kind, handle);
}
