// Reads OpenEXR pictures of one part, in scan lines or tiles, such as environment maps. Returns rgb floats, rows from
// the top; of tiles, the largest level. Reads all compressions. Throws Error where the bytes are no such picture.
// Source: OpenEXR 3, its technical introduction.
import {expected, halfAt, kBytes, kMaxEach, kNames, kRows, kTypes, Reader, unpack} from "./exr_blocks.js";

const kMagic = 20000630, kTiles = 0x200, kDeep = 0x800, kParts = 0x1000;
const kMaxPixels = 1 << 26, kMaxValue = 60000;  // limits of the drawn picture

const isExr = (bytes) => bytes.length > 8 && new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true) === kMagic;

// Returns {attribute: Reader}; "tiles" only where there are tiles.
function readHeader(from) {
  if (from.u32() !== kMagic) throw expected("an OpenEXR file", "another file");
  const flags = from.u32();
  if (flags & (kDeep | kParts)) throw expected("flat pixels of one part", flags & kDeep ? "deep pixels" : "several parts");
  const header = new Map();
  for (let name; (name = from.text()) !== "";) {
    from.text();
    header.set(name, new Reader(from.take(from.i32())));
  }
  if (!(flags & kTiles)) header.delete("tiles");
  else if (!header.has("tiles")) throw expected("an attribute tiles", "none");
  return header;
}

function readChannels(from) {
  const channels = [];
  for (let name; (name = from.text()) !== "";) {
    const type = from.i32();
    const curved = from.u8() > 0;
    from.take(3);
    const sampling = [from.i32(), from.i32()];
    if (!(type >= 0 && type <= 2)) throw expected(`a type of channel ${name}`, type);
    if (sampling.some((s) => s !== 1)) throw expected(`channel ${name} at every pixel`, sampling.join(" x "));
    channels.push({name, type, curved});
  }
  return channels;
}

// Returns true if the bytes are a picture. A model of burnish has tables as channels, and slices of a measurement are
// no picture either. Tiles and deep pixels exist in pictures alone, so they count as one.
export function isPicture(bytes) {
  if (!isExr(bytes)) return false;
  const flags = new Reader(bytes, 4).u32();
  if (flags & (kTiles | kDeep)) return true;
  try {
    const header = readHeader(new Reader(bytes)), names = readChannels(header.get("channels")).map(({name}) => name);
    return !header.has("burnish") && !header.has("phiDRange") && ["R", "G", "B"].every((name) => names.includes(name) || names.includes("Y"));
  } catch {
    return false;
  }
}

// Reads a picture of at most `most` pixels a side.
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

  const tiles = header.get("tiles"), [across, down] = tiles ? [tiles.u32(), tiles.u32()] : [width, kRows[compression]];
  if (!(across > 0 && down > 0)) throw expected("tiles of pixels", `${across} x ${down}`);
  const blocks = Math.ceil(width / across) * Math.ceil(height / down), pixelBytes = channels.reduce((sum, {type}) => sum + kBytes[type], 0);
  if (height * width * pixelBytes > kMaxEach[compression] * bytes.length) throw expected(`the bytes of ${width} x ${height} pixels`, bytes.length);
  const offsets = Array.from({length: blocks}, () => from.u64()), data = new Float32Array(3 * width * height);
  for (const offset of offsets) {
    if (!(offset < bytes.length)) throw expected("a block within the file", `one at ${offset}`);
    from.at = offset;
    const [x, y] = tiles ? firstOfTile(from, across, down) : [0, from.i32() - top], packed = from.take(from.i32());
    if (!(x >= 0 && x < width && y >= 0 && y < height)) throw expected("a block within the window", `column ${x}, row ${y}`);
    const how = {channels, width: Math.min(across, width - x), count: Math.min(down, height - y)}, block = await unpack(packed, compression, how);
    copyRows(new DataView(block.buffer, block.byteOffset), {...how, wanted, stride: width}, data.subarray(3 * (width * y + x)));
  }
  return {width, height, data};
}

// Returns column and row.
function firstOfTile(from, across, down) {
  const [column, row, levelX, levelY] = [0, 1, 2, 3].map(() => from.i32());
  if (levelX !== 0 || levelY !== 0) throw expected("tiles of the largest level first", `level ${levelX}, ${levelY}`);
  return [column * across, row * down];
}

function copyRows(view, {channels, wanted, width, count, stride}, to) {
  let at = 0;
  for (let y = 0; y < count; ++y)
    channels.forEach(({type}, channel) => {
      wanted.forEach((from, c) => {
        if (from === channel)
          for (let x = 0; x < width; ++x) to[3 * (y * stride + x) + c] = clean(number(view, type, at + kBytes[type] * x));
      });
      at += kBytes[type] * width;
    });
}
const number = (view, type, at) =>
  type === kTypes.half ? halfAt(view.getUint16(at, true)) : type === kTypes.float ? view.getFloat32(at, true) : view.getUint32(at, true);
const clean = (x) => (x > 0 ? Math.min(x, kMaxValue) : 0);
