// OpenEXR pictures of scan lines, as programs write light from all around: rgb floats, rows from the top. Compressions:
// none, RLE, ZIPS, ZIP, PIZ. Throws Error where the bytes say something else. Source: OpenEXR 3, its technical
// introduction, ImfPizCompressor, ImfHuf, ImfWav.

const kMagic = 20000630, kTiles = 0x200, kDeep = 0x800, kParts = 0x1000;
const kMaxPixels = 1 << 26, kMaxValue = 60000;  // of what is drawn
const kTypes = {half: 1, float: 2}, kBytes = [4, 2, 4];
const kNames = ["none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"];
const kRows = [1, 1, 1, 16, 32];  // of a block
// bytes that one byte can stand for: a run of RLE, zlib's longest match [RFC 1951], PIZ's 256 words in 10 bits
const kMaxEach = [1, 64, 1032, 1032, 410];
const expected = (what, found) => new Error(`.exr: expected ${what}, found ${found}`);

// Little-endian numbers and texts; past the end there are none.
class Reader {
  constructor(bytes, at = 0) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = at;
  }
  need(count) {
    if (count < 0 || this.at + count > this.bytes.length) throw expected(`${count} bytes at byte ${this.at}`, this.bytes.length - this.at);
    return (this.at += count) - count;
  }
  u8() { return this.bytes[this.need(1)]; }
  u16() { return this.view.getUint16(this.need(2), true); }
  u32() { return this.view.getUint32(this.need(4), true); }
  i32() { return this.view.getInt32(this.need(4), true); }
  u64() { return this.u32() + 2 ** 32 * this.u32(); }
  take(count) { return this.bytes.subarray(this.need(count), this.at); }
  text() {
    let text = "";
    for (let c; (c = this.u8()) !== 0;) text += String.fromCharCode(c);
    return text;
  }
}

const isExr = (bytes) => bytes.length > 8 && new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true) === kMagic;

// {attribute: Reader}.
function readHeader(from) {
  if (from.u32() !== kMagic) throw expected("an OpenEXR file", "another");
  const flags = from.u32();
  if (flags & (kTiles | kDeep | kParts)) throw expected("scan lines of one part", flags & kTiles ? "tiles" : flags & kDeep ? "deep pixels" : "several parts");
  const header = new Map();
  for (let name; (name = from.text()) !== "";) {
    from.text();
    header.set(name, new Reader(from.take(from.i32())));
  }
  return header;
}

function readChannels(from) {
  const channels = [];
  for (let name; (name = from.text()) !== "";) {
    const type = from.i32();
    from.u32();
    const sampling = [from.i32(), from.i32()];
    if (!(type >= 0 && type <= 2)) throw expected(`a type of channel ${name}`, type);
    if (sampling.some((s) => s !== 1)) throw expected(`channel ${name} at every pixel`, sampling.join(" x "));
    channels.push({name, type});
  }
  return channels;
}

// Whether the bytes are a picture rather than a model of burnish, whose channels are tables; what only pictures are (tiles,
// deep pixels) counts as one.
export function isPicture(bytes) {
  if (!isExr(bytes)) return false;
  const flags = new Reader(bytes, 4).u32();
  if (flags & (kTiles | kDeep)) return true;
  try {
    const header = readHeader(new Reader(bytes)), names = readChannels(header.get("channels")).map(({name}) => name);
    return !header.has("burnish") && ["R", "G", "B"].every((name) => names.includes(name) || names.includes("Y"));
  } catch {
    return false;
  }
}

// Of at most `most` pixels a side.
export async function readExr(bytes, most = 8192) {
  const from = new Reader(bytes), header = readHeader(from);
  for (const name of ["channels", "compression", "dataWindow"]) if (!header.has(name)) throw expected(`an attribute ${name}`, "none");
  const channels = readChannels(header.get("channels")), compression = header.get("compression").u8(), window = header.get("dataWindow");
  if (!(compression < kRows.length)) throw expected(`a compression of ${kNames.slice(0, kRows.length).join(", ")}`, kNames[compression] ?? compression);
  const [left, top, right, bottom] = [0, 1, 2, 3].map(() => window.i32()), width = right - left + 1, height = bottom - top + 1;
  if (!(width > 0 && height > 0 && width * height <= kMaxPixels)) throw expected("a window of pixels", `${width} x ${height}`);
  if (width > most || height > most) throw expected(`at most ${most} x ${most} pixels`, `${width} x ${height}`);
  const place = ["R", "G", "B"].map((name) => channels.findIndex((c) => c.name === name)), grey = channels.findIndex((c) => c.name === "Y");
  const wanted = place.includes(-1) ? [grey, grey, grey] : place;
  if (wanted[0] < 0) throw expected("channels R, G, B or Y", channels.map(({name}) => name).join(", "));

  const rows = kRows[compression], blocks = Math.ceil(height / rows), rowBytes = width * channels.reduce((sum, {type}) => sum + kBytes[type], 0);
  if (height * rowBytes > kMaxEach[compression] * bytes.length) throw expected(`the bytes of ${width} x ${height} pixels`, bytes.length);
  const offsets = Array.from({length: blocks}, () => from.u64()), data = new Float32Array(3 * width * height);
  for (const offset of offsets) {
    if (!(offset < bytes.length)) throw expected("a block within the file", `one at ${offset}`);
    from.at = offset;
    const first = from.i32() - top, packed = from.take(from.i32());
    if (!(first >= 0 && first < height)) throw expected("a block within the window", `row ${first}`);
    const count = Math.min(rows, height - first), size = count * rowBytes;
    const block = packed.length === size ? packed.slice() : await unpack(packed, compression, size, {channels, width, count});
    copyRows(new DataView(block.buffer, block.byteOffset), {channels, wanted, width, count}, data.subarray(3 * width * first));
  }
  return {width, height, data};
}

function copyRows(view, {channels, wanted, width, count}, to) {
  let at = 0;
  for (let y = 0; y < count; ++y)
    channels.forEach(({type}, channel) => {
      wanted.forEach((from, c) => {
        if (from === channel)
          for (let x = 0; x < width; ++x) to[3 * (y * width + x) + c] = clean(number(view, type, at + kBytes[type] * x));
      });
      at += kBytes[type] * width;
    });
}
const number = (view, type, at) =>
  type === kTypes.half ? half(view.getUint16(at, true)) : type === kTypes.float ? view.getFloat32(at, true) : view.getUint32(at, true);
const clean = (x) => (x > 0 ? Math.min(x, kMaxValue) : 0);
function half(bits) {
  const exponent = (bits >> 10) & 31, fraction = bits & 1023, sign = bits & 0x8000 ? -1 : 1;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24);
}

async function unpack(packed, compression, size, how) {
  if (compression === 0) throw expected(`${size} bytes of rows`, packed.length);
  if (compression === 4) return unpackPiz(new Reader(packed), size, how);
  return interleaved(compression === 1 ? runs(packed, size) : await inflate(packed, size));
}

async function inflate(packed, size) {
  const bytes = new Uint8Array(size), reader = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  let at = 0;
  try {
    for (let part; !(part = await reader.read()).done; at += part.value.length) {
      if (at + part.value.length > size) throw expected(`${size} bytes in a block`, "more");
      bytes.set(part.value, at);
    }
  } catch (error) {
    throw error.message.startsWith(".exr") ? error : expected("zlib's bytes", "others");
  }
  if (at !== size) throw expected(`${size} bytes in a block`, at);
  return bytes;
}
function runs(packed, size) {
  const bytes = new Uint8Array(size), from = new Reader(packed);
  for (let at = 0; at < size;) {
    const code = (from.u8() << 24) >> 24, count = code < 0 ? -code : code + 1;
    if (at + count > size) throw expected(`a run of at most ${size - at}`, count);
    if (code < 0) bytes.set(from.take(count), at);
    else bytes.fill(from.u8(), at, at + count);
    at += count;
  }
  return bytes;
}
// Sums of differences, whose even places stand before the odd ones.
function interleaved(bytes) {
  const result = new Uint8Array(bytes.length), odd = (bytes.length + 1) >> 1;
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1] - 128;
  for (let i = 0; i < bytes.length; ++i) result[i] = bytes[(i >> 1) + (i & 1 ? odd : 0)];
  return result;
}

// PIZ: the values that occur, numbered; a wavelet of their numbers; Huffman's code of that.
function unpackPiz(from, size, {channels, width, count}) {
  const least = from.u16(), most = from.u16(), bits = new Uint8Array(8192);
  if (most >= bits.length) throw expected("a list of values up to 8191", most);
  if (least <= most) bits.set(from.take(most - least + 1), least);
  const values = [0];
  for (let i = 1; i < 65536; ++i) if (bits[i >> 3] & (1 << (i & 7))) values.push(i);
  const words = huffman(new Reader(from.take(from.i32())), size / 2), result = new Uint8Array(size), to = new DataView(result.buffer);
  let start = 0;
  for (const channel of channels) {
    const parts = kBytes[channel.type] / 2;
    for (let k = 0; k < parts; ++k) wavelet(words, start + k, width, parts, count, width * parts, values.length - 1);
    [channel.start, channel.words] = [start, width * parts];
    start += count * channel.words;
  }
  let at = 0;
  for (let y = 0; y < count; ++y)
    for (const channel of channels)
      for (let x = 0; x < channel.words; ++x, at += 2) to.setUint16(at, values[words[channel.start + y * channel.words + x]] ?? 0, true);
  return result;
}

// Lengths of codes of all symbols, six bits each, runs of zeros shorter.
function codeLengths(next, first, last) {
  const lengths = new Uint8Array(65537);
  for (let i = first; i <= last;) {
    const length = next(6);
    if (length < 59) {
      lengths[i++] = length;
      continue;
    }
    const zeros = length === 63 ? next(8) + 6 : length - 57;
    if (i + zeros > last + 1) throw expected(`at most ${last + 1 - i} symbols without a code`, zeros);
    i += zeros;
  }
  return lengths;
}

function huffman(from, size) {
  const [first, last] = [from.u32(), from.u32()], words = new Uint16Array(size);
  from.u32();
  const bitCount = from.u32();
  from.u32();
  if (!(first <= last && last <= 65536)) throw expected("symbols up to 65536", `${first} to ${last}`);
  let held = 0, have = 0;
  const next = (count) => {
    let value = 0;
    for (; count > 0; --count) {
      if (have === 0) [held, have] = [from.u8(), 8];
      value = 2 * value + ((held >> --have) & 1);
    }
    return value;
  };
  const lengths = codeLengths(next, first, last);
  // the codes of a length follow each other, longer ones below
  const counts = new Array(59).fill(0), starts = new Array(59).fill(0), symbols = Array.from({length: 59}, () => []);
  for (let s = first; s <= last; ++s) if (lengths[s]) (++counts[lengths[s]], symbols[lengths[s]].push(s));
  for (let length = 58, code = 0; length > 0; --length) [starts[length], code] = [code, Math.floor((code + counts[length]) / 2)];
  have = 0;  // the data start at a byte
  const end = from.at + Math.ceil(bitCount / 8);
  for (let at = 0; at < size;) {
    let code = 0, length = 0, symbol;
    do {
      if (++length > 58 || from.at > end) throw expected("one of Huffman's codes", "another");
      code = 2 * code + next(1);
      symbol = code >= starts[length] ? symbols[length][code - starts[length]] : undefined;
    } while (symbol === undefined);
    if (symbol !== last) {
      words[at++] = symbol;
      continue;
    }
    const again = next(8);
    if (at === 0 || at + again > size) throw expected(`a run of at most ${size - at}`, again);
    words.fill(words[at - 1], at, at + again);
    at += again;
  }
  return words;
}

// Sums and differences back to the two values that they are of.
function pair14(words, i, j) {
  const high = (words[j] << 16) >> 16, a = ((words[i] << 16) >> 16) + (high & 1) + (high >> 1);
  words[i] = a;
  words[j] = a - high;
}
function pair16(words, i, j) {
  const high = words[j], b = (words[i] - (high >> 1)) & 65535;
  words[i] = high + b - 32768;
  words[j] = b;
}
function wavelet(words, start, width, stepX, height, stepY, largest) {
  const pair = largest < 1 << 14 ? pair14 : pair16, least = Math.min(width, height);
  let p = 1;
  while (p <= least) p <<= 1;
  p >>= 1;
  for (let two = p, one = p >> 1; one >= 1; two = one, one >>= 1) {
    let y = 0;
    for (; y + two <= height; y += two) {
      let x = 0;
      const row = start + y * stepY, next = row + one * stepY;
      for (; x + two <= width; x += two) {
        const i = x * stepX, j = (x + one) * stepX;
        pair(words, row + i, next + i);
        pair(words, row + j, next + j);
        pair(words, row + i, row + j);
        pair(words, next + i, next + j);
      }
      if (width & one) pair(words, row + x * stepX, next + x * stepX);
    }
    if (height & one) for (let x = 0; x + two <= width; x += two) pair(words, start + y * stepY + x * stepX, start + y * stepY + (x + one) * stepX);
  }
}
