// The one door to the library.
export {open, preload} from "./package/index.js";

// Of what was opened just now, which is closed again where it has none.
export async function infoOf(material, call) {
  try {
    return await material.info(call);
  } catch (error) {
    material.close();
    throw error;
  }
}
