// A link that carries a model: #m=NAME.BASE64URL, the bytes those of its .burnish file. Nothing of it becomes markup.
import {openOne} from "./materials.js";
import {say} from "./dom.js";

const kLongest = 1 << 20;  // characters of a fragment that is read

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

export function linkOf(name, bytes) {
  const short = name.replace(/[^\w-]+/g, "_").slice(0, 40);
  return `${location.origin}${location.pathname}#m=${short}.${toBase64Url(bytes)}`;
}

// Opens what the page's fragment carries, if it does.
export async function openLink() {
  const fragment = location.hash;
  if (!fragment.startsWith("#m=")) return;
  const [, name, data] = fragment.slice(0, kLongest).match(/^#m=([\w-]{0,40})\.(.*)$/) ?? [];
  try {
    if (!data || fragment.length > kLongest) throw new Error("expected #m=NAME.DATA");
    await openOne(fromBase64Url(data), `${name || "linked"}.burnish`);
  } catch (error) {
    say(`The link carries no material: ${error.message}`, "error");
  }
}
