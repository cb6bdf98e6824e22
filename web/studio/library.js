// This file is the only import of the library.
export {open, preload} from "./package/index.js";

// Returns the information of a material just opened. Closes the material where that fails.
export async function infoOf(material, call) {
  try {
    return await material.info(call);
  } catch (error) {
    material.close();
    throw error;
  }
}
