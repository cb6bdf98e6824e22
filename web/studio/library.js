// The one door to the library.
export {open} from "./package/burnish.js";
