// Radiance .hdr pictures: rgb floats, rows from the top. Throws Error where the bytes say something else.
export function readHdr(bytes) {
  let at = 0;
  const line = () => {
    const end = bytes.indexOf(10, at);
    if (end < 0 || end - at > 1000) throw new Error(`.hdr: expected a line of text at byte ${at}`);
    const text = String.fromCharCode(...bytes.subarray(at, end));
    at = end + 1;
    return text;
  };
  if (!line().startsWith("#?")) throw new Error(".hdr: expected #? at byte 0");
  while (line() !== "");
  const size = line().match(/^-Y (\d+) \+X (\d+)$/);
  if (!size) throw new Error(".hdr: expected a size such as -Y 512 +X 1024");
  const [height, width] = [Number(size[1]), Number(size[2])];
  if (!(width > 0 && height > 0 && width <= 8192 && height <= 8192)) throw new Error(`.hdr: expected at most 8192 x 8192 pixels, found ${width} x ${height}`);
  const data = new Float32Array(3 * width * height), row = new Uint8Array(4 * width);
  for (let y = 0; y < height; ++y) {
    readRow(bytes, row, width);
    for (let x = 0; x < width; ++x) {
      const factor = row[3 * width + x] ? 2 ** (row[3 * width + x] - 136) : 0;
      for (let c = 0; c < 3; ++c) data[3 * (y * width + x) + c] = Math.min(row[c * width + x] * factor, 60000);
    }
  }
  return {width, height, data};

  // One row as planes of r, g, b and exponent.
  function readRow(bytes, row, width) {
    const packed = width >= 8 && width < 32768 && bytes[at] === 2 && bytes[at + 1] === 2 && ((bytes[at + 2] << 8) | bytes[at + 3]) === width;
    const need = (count) => {
      if (at + count > bytes.length) throw new Error(`.hdr: expected ${count} bytes at byte ${at}, found ${bytes.length - at}`);
    };
    if (!packed) {
      need(4 * width);
      for (let x = 0; x < width; ++x) for (let c = 0; c < 4; ++c) row[c * width + x] = bytes[at++];
      return;
    }
    at += 4;
    for (let to = 0; to < 4 * width;) {
      need(2);
      const code = bytes[at++], run = code > 128, count = run ? code - 128 : code;
      const left = width - (to % width);
      if (count === 0 || count > left) throw new Error(`.hdr: expected a run of 1 to ${left} at byte ${at - 1}, found ${count}`);
      if (!run) need(count);
      for (let k = 0; k < count; ++k) row[to++] = run ? bytes[at] : bytes[at++];
      if (run) ++at;
    }
  }
}
