// Packs several files into one archive [PKWARE APPNOTE 6.3.10].

const kLocal = 0x04034b50, kEntry = 0x02014b50, kEnd = 0x06054b50, kVersion = 20, kUtf8 = 0x800, kDeflated = 8, kDate = 0x21;

// Writes numbers of two and four bytes, lowest first: [[bytes, value], ...].
function words(...list) {
  const data = new DataView(new ArrayBuffer(list.reduce((sum, [size]) => sum + size, 0)));
  let at = 0;
  for (const [size, value] of list) {
    if (size === 2) data.setUint16(at, value, true);
    else data.setUint32(at, value, true);
    at += size;
  }
  return new Uint8Array(data.buffer);
}

// Returns a deflated file with its checksum and size. gzip [RFC 1952] has the data between a head of 10 bytes and a
// tail of 8, which has the checksum and size.
async function packed(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream("gzip")), all = new Uint8Array(await new Response(stream).arrayBuffer());
  const tail = new DataView(all.buffer, all.length - 8);
  return {data: all.subarray(10, -8), checksum: tail.getUint32(0, true), size: tail.getUint32(4, true)};
}

// Returns the archive's bytes, from files {name, bytes}.
export async function zip(files) {
  const parts = [], entries = [];
  let at = 0;
  for (const file of files) {
    const name = new TextEncoder().encode(file.name), {data, checksum, size} = await packed(file.bytes);
    const shared = [[2, kVersion], [2, kUtf8], [2, kDeflated], [2, 0], [2, kDate], [4, checksum], [4, data.length], [4, size], [2, name.length], [2, 0]];
    entries.push(words([4, kEntry], [2, kVersion], ...shared, [2, 0], [2, 0], [2, 0], [4, 0], [4, at]), name);
    parts.push(words([4, kLocal], ...shared), name, data);
    at += 30 + name.length + data.length;
  }
  const length = entries.reduce((sum, part) => sum + part.length, 0), count = [2, files.length];
  return new Blob([...parts, ...entries, words([4, kEnd], [2, 0], [2, 0], count, count, [4, length], [4, at], [2, 0])]);
}
