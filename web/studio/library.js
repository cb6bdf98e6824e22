// The one door to the library.
export {open, preload} from "./package/index.js";
