// A link that carries a model: #m=NAME.BASE64URL, the bytes of its .burnish file. None of it becomes markup.
import {openOne} from "./materials.js";
import {lineOf, say} from "./dom.js";

const kLongest = 1 << 20;  // characters of a fragment, both written and read
const kTag = [0xd9, 0xd9, 0xf7], kText = [0x67, ...new TextEncoder().encode("burnish")];

// Returns true if the bytes start as a .burnish file does: a tag, a list, its name. No other reader sees a link's
// bytes.
const isCompact = (bytes) => [...kTag, 0x80, ...kText].every((byte, k) => (k === kTag.length ? bytes[k] & 0xe0 : bytes[k]) === byte);

function toBase64Url(bytes) {
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}
// Throws Error where the text is not base64url.
function fromBase64Url(text) {
  if (!/^[A-Za-z0-9_-]*$/.test(text)) throw new Error("expected base64url");
  return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
}

// Throws Error where the fragment would be too long to be read.
export function linkOf(name, bytes) {
  const short = name.replace(/[^\w-]+/g, "_").slice(0, 40), fragment = `#m=${short}.${toBase64Url(bytes)}`;
  if (fragment.length > kLongest) throw new Error(`A link holds at most ${kLongest.toLocaleString("en")} characters, this model takes ${fragment.length.toLocaleString("en")}: share its .burnish file instead`);
  return `${location.origin}${location.pathname}${fragment}`;
}

// Opens the model of the page's fragment, if there is one.
export async function openLink() {
  const fragment = location.hash;
  if (!fragment.startsWith("#m=")) return;
  try {
    if (fragment.length > kLongest) throw new Error(`expected at most ${kLongest.toLocaleString("en")} characters, found ${fragment.length.toLocaleString("en")}`);
    const [, name, data] = fragment.match(/^#m=([\w-]{0,40})\.(.*)$/) ?? [];
    if (!data) throw new Error("expected #m=NAME.DATA");
    const bytes = fromBase64Url(data);
    if (!isCompact(bytes)) throw new Error("expected the bytes of a .burnish file, found other bytes");
    await openOne(bytes, `${name || "linked"}.burnish`);
  } catch (error) {
    say(`The link carries no material: ${lineOf(error)}`, "error");
  }
}
