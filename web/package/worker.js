// The library in a Web Worker or one of Node's: takes a request, sends progress and a reply, one at a time.
import createLibrary from "./burnish.js";

const inNode = typeof process === "object" && Boolean(process.versions?.node);
const port = inNode ? (await import("node:worker_threads")).parentPort : self;
if (inNode) globalThis.self ??= {location: {href: import.meta.url}};

let library, memory, current;

// `threads` are beside this one and share its memory. `threadCode` is their script.
async function start({module, threads = 0, threadCode}) {
  if (threads > 0) memory = new WebAssembly.Memory({initial: 512, maximum: 32768, shared: true});
  library = await createLibrary({
    threads,
    wasmMemory: memory,
    locateFile: () => threadCode,
    mainScriptUrlOrBlob: threadCode,
    instantiateWasm: (imports, done) => {
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
    print: () => {},
    printErr: () => {},
    progress: (stage, fraction) => port.postMessage({call: current, progress: {stage, fraction}}),
  });
  if (threads > 0) library._burnish_start_threads(threads);
}

// The heap is read anew, since another thread may have enlarged it.
const heap = () => memory ? new Uint8Array(memory.buffer) : library.HEAPU8;

function withText(text, use) {
  const bytes = new TextEncoder().encode(text + "\0"), place = library._malloc(bytes.length);
  if (!place) throw new Error("expected enough memory, found none left");
  try {
    heap().set(bytes, place);
    return use(place);
  } finally {
    library._free(place);
  }
}

function textAt(place) {
  const bytes = heap(), end = bytes.indexOf(0, place);
  return new TextDecoder().decode(bytes.slice(place, end));
}

function answer({request, bytes}) {
  if (bytes?.byteLength > 0) {
    const place = library._burnish_buffer(bytes.byteLength);
    if (!place) throw new Error("expected enough memory, found none left");
    heap().set(new Uint8Array(bytes), place);
    bytes.transfer?.(0);  // the library has them: browsers that can, free theirs while it works
  }
  const done = withText(JSON.stringify(request), (text) => library._burnish_call(text));
  const text = textAt(library._burnish_text());
  if (!done) throw new Error(text);
  const blobs = [];
  for (let i = 0; i < library._burnish_blobs(); ++i) {
    const at = library._burnish_blob(i);
    blobs.push(heap().slice(at, at + library._burnish_blob_size(i)).buffer);
  }
  library._burnish_clear();
  return {json: JSON.parse(text), blobs, memory: heap().length};
}

const receive = async (message) => {
  if (message.module) {
    try {
      await start(message);
      port.postMessage({});
    } catch (error) {
      port.postMessage({error: `the library could not be started: ${error?.message ?? error}`});
    }
    return;
  }
  current = message.call;
  try {
    const reply = answer(message);
    port.postMessage({call: message.call, reply}, reply.blobs);
  } catch (error) {
    // Another error than the library's leaves it in an unknown state.
    const fatal = !(error instanceof Error) || error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    const text = error?.message ?? String(error);
    port.postMessage({call: message.call, error: fatal ? `the library stopped: ${text}` : text, fatal});
  }
};

// Messages run in their order; the first is the module.
let last = Promise.resolve();
const queue = (message) => {
  last = last.then(() => receive(message));
};
if (inNode) port.on("message", queue);
else self.onmessage = (event) => queue(event.data);
