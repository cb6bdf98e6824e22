// Unpacks the blocks of OpenEXR pictures. DWA is in exr_dwa.js. Source: OpenEXR 3, its technical introduction,
// ImfPizCompressor, ImfHuf, ImfWav, ImfPxr24Compressor, ImfB44Compressor.
import {unpackDwa} from "./exr_dwa.js";

export const kTypes = {half: 1, float: 2}, kBytes = [4, 2, 4];
export const kNames = ["none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"];
export const kRows = [1, 1, 1, 16, 32, 16, 32, 32, 32, 256];  // rows of a block
// These are the most bytes that one packed byte can stand for: a run of RLE, or zlib's longest match [RFC 1951], for
// PXR24 with three quarters of a float. PIZ has 256 words in 10 bits, B44 a square in three bytes. DWA has a square in
// a word of each of its parts, which zlib packs.
export const kMaxEach = [1, 64, 1032, 1032, 410, 1376, 11, 11, 32 * 1032, 32 * 1032];
const kPlanes = [4, 2, 3];  // bytes of values in PXR24
const kFlat = 13;           // the least shift that marks a square of one value
export const expected = (what, found) => new Error(`.exr: expected ${what}, found ${found}`);

// Reads little-endian numbers and texts. Reading past the end throws Error.
export class Reader {
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
  u16Big() { return this.view.getUint16(this.need(2)); }
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

// Returns the bytes of a block's rows, each with channel after channel. `how` has {channels, width, count} of pixels
// and rows.
export async function unpack(packed, compression, how) {
  const size = sizeOf(how, kBytes);
  if (packed.length === size) return packed.slice();
  switch (kNames[compression]) {
    case "RLE": return interleaved(runs(packed, size));
    case "ZIPS": case "ZIP": return interleaved(await inflate(packed, size));
    case "PIZ": return unpackPiz(new Reader(packed), size, how);
    case "PXR24": return planes(await inflate(packed, sizeOf(how, kPlanes)), size, how);
    case "B44": case "B44A": return inRows(squares(new Reader(packed), how), size, how);
    case "DWAA": case "DWAB": return inRows(await unpackDwa(new Reader(packed), how), size, how);
    default: throw expected(`${size} bytes of rows`, packed.length);
  }
}
const sizeOf = ({channels, width, count}, bytes) => count * width * channels.reduce((sum, {type}) => sum + bytes[type], 0);

export async function inflate(packed, size) {
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
export function runs(packed, size) {
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
// Undoes differences between neighbours. Even places stand before the odd ones.
export function interleaved(bytes) {
  const result = new Uint8Array(bytes.length), odd = (bytes.length + 1) >> 1;
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1] - 128;
  for (let i = 0; i < bytes.length; ++i) result[i] = bytes[(i >> 1) + (i & 1 ? odd : 0)];
  return result;
}

// PXR24 stores a row's highest bytes, then the next ones. Each value is the sum of the steps before it.
function planes(bytes, size, {channels, width, count}) {
  const result = new Uint8Array(size), to = new DataView(result.buffer);
  let from = 0, at = 0;
  for (let y = 0; y < count; ++y)
    for (const {type} of channels) {
      const parts = kPlanes[type], shift = 8 * (4 - parts);
      for (let x = 0, value = 0; x < width; ++x, at += kBytes[type]) {
        let step = 0;
        for (let k = 0; k < parts; ++k) step = (step << 8) | bytes[from + k * width + x];
        value = (value + (type === kTypes.half ? step : step << shift)) | 0;
        if (type === kTypes.half) to.setUint16(at, value & 65535, true);
        else to.setUint32(at, value >>> 0, true);
      }
      from += parts * width;
    }
  return result;
}

export function halfAt(bits) {
  const exponent = (bits >> 10) & 31, fraction = bits & 1023, sign = bits & 0x8000 ? -1 : 1;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24);
}

// Reorders rows of each channel to channels of each row.
function inRows(parts, size, {channels, width, count}) {
  const result = new Uint8Array(size);
  let at = 0;
  for (let y = 0; y < count; ++y)
    channels.forEach(({type}, c) => {
      const bytes = kBytes[type] * width;
      result.set(parts[c].subarray(y * bytes, (y + 1) * bytes), at);
      at += bytes;
    });
  return result;
}

// B44 stores a channel of halves in squares of 4 x 4, as places in the order of size. Other channels are stored as they
// are.
function squares(from, {channels, width, count}) {
  return channels.map(({name, type, curved}) => {
    if (type !== kTypes.half) return from.take(kBytes[type] * width * count);
    if (curved) throw expected(`linear values of channel ${name}`, "logarithms");
    const result = new Uint8Array(2 * width * count), to = new DataView(result.buffer);
    for (let top = 0; top < count; top += 4)
      for (let left = 0; left < width; left += 4) {
        const square = squareOf(from);
        for (let y = 0; y < Math.min(4, count - top); ++y)
          for (let x = 0; x < Math.min(4, width - left); ++x) to.setUint16(2 * ((top + y) * width + left + x), square[4 * y + x], true);
      }
    return result;
  });
}
// Reads the first value in 16 bits, then numbers of six bits: a shift, the steps down the first column, and the steps
// to the right in each row.
function squareOf(from) {
  const values = new Array(16), first = from.u16Big(), shift = from.u8() >> 2;
  if (shift >= kFlat) return values.fill(halfOfPlace(first));
  --from.at;
  let held = 0, have = 0;
  const step = () => {
    for (; have < 6; have += 8) held = ((held << 8) | from.u8()) & 0xffff;
    have -= 6;
    return (((held >> have) & 63) - 32) << shift;
  };
  step();  // the shift
  values[0] = first;
  for (let y = 1; y < 4; ++y) values[4 * y] = (values[4 * y - 4] + step()) & 65535;
  for (let x = 1; x < 4; ++x) for (let y = 0; y < 4; ++y) values[4 * y + x] = (values[4 * y + x - 1] + step()) & 65535;
  return values.map(halfOfPlace);
}
const halfOfPlace = (place) => (place & 0x8000 ? place & 0x7fff : ~place & 65535);

// PIZ numbers the values that occur, transforms the numbers by a wavelet, and packs them by Huffman's code.
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

// Reads the lengths of all symbols' codes, six bits each. Runs of zeros are shorter.
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

export function huffman(from, size) {
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
  // Codes of one length are consecutive; longer codes have lower values.
  const counts = new Array(59).fill(0), starts = new Array(59).fill(0), symbols = Array.from({length: 59}, () => []);
  for (let s = first; s <= last; ++s) if (lengths[s]) (++counts[lengths[s]], symbols[lengths[s]].push(s));
  for (let length = 58, code = 0; length > 0; --length) [starts[length], code] = [code, Math.floor((code + counts[length]) / 2)];
  have = 0;  // the data start at a byte
  const end = from.at + Math.ceil(bitCount / 8);
  for (let at = 0; at < size;) {
    let code = 0, length = 0, symbol;
    do {
      if (++length > 58 || from.at > end) throw expected("one of Huffman's codes", "another code");
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

// Turns sums and differences back into the two values.
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
