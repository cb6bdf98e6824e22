// Reads Radiance .hdr pictures: rgb floats, rows from the top, at most `most` pixels a side. Throws Error where the
// bytes are no such picture. Rows are flat, coded by planes, or have pixels (1, 1, 1, n) that repeat the pixel before.
// Source: Radiance, its file formats and color.c.
export function readHdr(bytes, most = 8192) {
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
  if (!(width > 0 && height > 0 && width <= most && height <= most)) throw new Error(`.hdr: expected at most ${most} x ${most} pixels, found ${width} x ${height}`);
  const row = new Uint8Array(4 * width), begin = at;
  // The bytes are read once before, so memory for the picture is taken only where all of it exists.
  for (let y = 0; y < height; ++y) readRow();
  at = begin;
  const data = new Float32Array(3 * width * height);
  for (let y = 0; y < height; ++y) {
    readRow();
    for (let x = 0; x < width; ++x) {
      const factor = row[3 * width + x] ? 2 ** (row[3 * width + x] - 136) : 0;
      for (let c = 0; c < 3; ++c) data[3 * (y * width + x) + c] = Math.min(row[c * width + x] * factor, 60000);
    }
  }
  return {width, height, data};

  function need(count) {
    if (at + count > bytes.length) throw new Error(`.hdr: expected ${count} bytes at byte ${at}, found ${bytes.length - at}`);
  }
  // Reads one row as planes of r, g, b and exponent.
  function readRow() {
    if (width >= 8 && width < 32768 && bytes[at] === 2 && bytes[at + 1] === 2 && ((bytes[at + 2] << 8) | bytes[at + 3]) === width) readPlanes();
    else readPixels();
  }
  function readPlanes() {
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
  // Consecutive repeats are digits of one number, the lowest first.
  function readPixels() {
    for (let x = 0, digit = 1; x < width;) {
      need(4);
      const repeats = bytes[at] === 1 && bytes[at + 1] === 1 && bytes[at + 2] === 1, count = repeats ? bytes[at + 3] * digit : 1;
      const left = repeats && x === 0 ? 0 : width - x;
      if (count > left || digit > 1 << 24) throw new Error(`.hdr: expected at most ${left} repeats at byte ${at}, found ${count}`);
      for (let c = 0; c < 4; ++c) row.fill(repeats ? row[c * width + x - 1] : bytes[at + c], c * width + x, c * width + x + count);
      at += 4;
      x += count;
      digit = repeats ? 256 * digit : 1;
    }
  }
}
