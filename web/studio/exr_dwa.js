// Unpacks blocks of OpenEXR pictures with DWAA and DWAB. R, G and B are squares of 8 x 8 cosines, A has runs, and other
// channels zlib's bytes.
// Source: OpenEXR 3, ImfDwaCompressor, internal_dwa_helpers.
import {expected, halfAt, huffman, inflate, interleaved, kBytes, kTypes, Reader, runs} from "./exr_blocks.js";

const kSizes = ["version", "otherRaw", "otherPacked", "acPacked", "dcPacked", "runsPacked", "runsRaw", "runsSize", "acCount", "dcCount", "acPacking"];
const kOther = 0, kCosines = 1, kRuns = 2;  // the packing of a channel
const kSide = 8, kSquare = 64, kEnd = 0xff00;

// The places of a square's coefficients, from the mean on along its diagonals.
const kZigzag = (() => {
  const places = Array.from({length: kSquare}, (_, i) => ({x: i % kSide, y: Math.floor(i / kSide)}));
  const along = ({x, y}) => ((x + y) % 2 ? y : x);
  return places.sort((a, b) => a.x + a.y - b.x - b.y || along(a) - along(b)).map(({x, y}) => kSide * y + x);
})();
// The cosine transform's orthonormal rows: [frequency][place].
const kCosine = Array.from({length: kSquare}, (_, i) => {
  const u = Math.floor(i / kSide), x = i % kSide;
  return (u === 0 ? Math.SQRT1_2 : 1) / 2 * Math.cos(((2 * x + 1) * u * Math.PI) / 16);
});

// Returns the half nearest to a number, ties to even.
function toHalf(x) {
  const sign = x < 0 || Object.is(x, -0) ? 0x8000 : 0, size = Math.abs(x);
  if (Number.isNaN(x)) return 0x7e00;
  if (size >= 65520) return sign | 0x7c00;
  const exponent = Math.max(Math.floor(Math.log2(Math.max(size, 2 ** -24))), -14), scaled = size * 2 ** (10 - exponent);
  let whole = Math.floor(scaled);
  const rest = scaled - whole;
  if (rest > 0.5 || (rest === 0.5 && whole % 2 === 1)) ++whole;
  return sign | (whole + (exponent + 14) * 1024);  // a carry takes the next exponent
}

// Stored values are roots up to 1 and logarithms above.
function toLinear(x) {
  const size = Math.abs(x);
  if (!Number.isFinite(x)) return 0;
  return Math.sign(x) * (size <= 1 ? size ** 2.2 : Math.exp(2.2 * (size - 1)));
}

// Reads [{suffix, packing, place, type, anyCase}]. The first rule that matches a channel gives its packing.
function readRules(from) {
  const end = from.at + from.u16(), rules = [];
  while (from.at < end) {
    const suffix = from.text(), value = from.u8();
    rules.push({suffix, packing: (value >> 2) & 3, place: (value >> 4) - 1, anyCase: (value & 1) === 1, type: from.u8()});
  }
  if (from.at !== end) throw expected("whole rules of channels", "a part of one");
  return rules;
}

// Returns each channel with its packing, and the places of each colour's three channels.
function packings(rules, channels) {
  const colours = new Map();
  const packed = channels.map((channel) => {
    const dot = channel.name.lastIndexOf(".") + 1, suffix = channel.name.slice(dot), layer = channel.name.slice(0, dot);
    const rule = rules.find((r) => r.type === channel.type && (r.anyCase ? r.suffix.toLowerCase() === suffix.toLowerCase() : r.suffix === suffix));
    const made = {...channel, packing: rule?.packing ?? kOther};
    if (made.packing > kRuns) throw expected(`a packing of channel ${channel.name}`, made.packing);
    if (made.packing === kCosines && rule.place >= 0) colours.set(layer, Object.assign(colours.get(layer) ?? [], {[rule.place]: made}));
    return made;
  });
  return {packed, colours: [...colours.values()].filter((three) => three.length === 3 && three.every(Boolean) && Object.keys(three).length === 3)};
}

// Transforms a square's coefficients back to values.
function inverse(square, scratch) {
  for (let v = 0; v < kSide; ++v)
    for (let x = 0; x < kSide; ++x) {
      let sum = 0;
      for (let u = 0; u < kSide; ++u) sum += kCosine[kSide * u + x] * square[kSide * v + u];
      scratch[kSide * v + x] = sum;
    }
  for (let x = 0; x < kSide; ++x)
    for (let y = 0; y < kSide; ++y) {
      let sum = 0;
      for (let v = 0; v < kSide; ++v) sum += kCosine[kSide * v + y] * scratch[kSide * v + x];
      square[kSide * y + x] = sum;
    }
}

// Reads the coefficients after the mean: halves, runs of zeros and an end.
function readSquare(ac, square) {
  for (let k = 1; k < kSquare;) {
    if (ac.at >= ac.words.length) throw expected("a square's coefficients", "none");
    const word = ac.words[ac.at++];
    if (word === kEnd) return;
    if (word >> 8 === 0xff) k += word & 0xff;
    else square[kZigzag[k++]] = halfAt(word);
  }
}

// Reads one channel, or three that are luma and two differences, into their rows.
function readCosines(together, {width, count}, ac, dc) {
  const across = Math.ceil(width / kSide), down = Math.ceil(count / kSide), first = dc.at, scratch = new Float32Array(kSquare);
  if (first + together.length * across * down > dc.words.length) throw expected("the means of squares", "fewer");
  dc.at += together.length * across * down;
  const squares = together.map(() => new Float32Array(kSquare));
  for (let block = 0; block < across * down; ++block) {
    squares.forEach((square, c) => {
      square.fill(0);
      square[0] = halfAt(dc.words[first + c * across * down + block]);
      readSquare(ac, square);
      inverse(square, scratch);
    });
    const left = kSide * (block % across), top = kSide * Math.floor(block / across);
    for (let y = 0; y < Math.min(kSide, count - top); ++y)
      for (let x = 0; x < Math.min(kSide, width - left); ++x) {
        const at = kSide * y + x, [luma, blue, red] = squares.map((square) => square[at]);
        const values = together.length === 3 ? [luma + 1.5747 * red, luma - 0.1873 * blue - 0.4682 * red, luma + 1.8556 * blue] : [luma];
        values.forEach((value, c) => put(together[c], (top + y) * width + left + x, value));
      }
  }
}
function put({type, curved, view}, place, value) {
  const stored = halfAt(toHalf(value)), bits = toHalf(curved ? stored : toLinear(stored));
  if (type === kTypes.half) view.setUint16(2 * place, bits, true);
  else view.setFloat32(4 * place, halfAt(bits), true);
}

const wordsOf = (bytes) => Uint16Array.from({length: bytes.length / 2}, (_, i) => bytes[2 * i] | (bytes[2 * i + 1] << 8));

// Reads the parts of a block, whose sizes stand in its head. A part without bytes gives nothing.
async function readParts(from, how) {
  const sizes = Object.fromEntries(kSizes.map((name) => [name, from.u64()])), cells = how.channels.length * how.width * how.count;
  if (sizes.version !== 2) throw expected("version 2 of DWA's blocks", sizes.version);
  for (const [name, most] of [["otherRaw", 4 * cells], ["runsSize", 4 * cells], ["runsRaw", 12 * cells], ["acCount", 2 * (cells + kSquare * (how.width + how.count + 8) * how.channels.length)],
                              ["dcCount", cells + 8]])
    if (sizes[name] > most) throw expected(`at most ${most} of ${name}`, sizes[name]);
  const rules = readRules(from), part = (name) => from.take(sizes[name]);
  const other = part("otherPacked"), ac = part("acPacked"), dc = part("dcPacked"), run = part("runsPacked");
  if (sizes.acPacking > 1) throw expected("Huffman's codes or zlib's bytes", sizes.acPacking);
  const acWords = ac.length === 0 ? new Uint16Array(0) : sizes.acPacking === 0 ? huffman(new Reader(ac), sizes.acCount) : wordsOf(await inflate(ac, 2 * sizes.acCount));
  return {
    rules, ac: {words: acWords, at: 0},
    dc: {words: dc.length ? wordsOf(interleaved(await inflate(dc, 2 * sizes.dcCount))) : new Uint16Array(0), at: 0},
    other: new Reader(other.length ? await inflate(other, sizes.otherRaw) : other),
    runs: new Reader(run.length ? runs(await inflate(run, sizes.runsRaw), sizes.runsSize) : run),
  };
}

// Returns channel after channel, each row after row.
export async function unpackDwa(from, how) {
  const {width, count} = how, parts = await readParts(from, how), {packed, colours} = packings(parts.rules, how.channels);
  for (const channel of packed) {
    channel.bytes = new Uint8Array(kBytes[channel.type] * width * count);
    channel.view = new DataView(channel.bytes.buffer);
    if (channel.packing === kCosines && channel.type === 0) throw expected(`halves or floats in channel ${channel.name}`, "whole numbers");
  }
  for (const three of colours) readCosines(three, how, parts.ac, parts.dc);
  for (const channel of packed) {
    if (colours.some((three) => three.includes(channel))) continue;
    if (channel.packing === kCosines) readCosines([channel], how, parts.ac, parts.dc);
    if (channel.packing === kOther) channel.bytes.set(parts.other.take(channel.bytes.length));
    if (channel.packing !== kRuns) continue;
    // The lowest bytes of all values stand first, then the next ones.
    const size = kBytes[channel.type], planes = Array.from({length: size}, () => parts.runs.take(width * count));
    planes.forEach((plane, k) => plane.forEach((byte, i) => (channel.bytes[size * i + k] = byte)));
  }
  return packed.map(({bytes}) => bytes);
}
