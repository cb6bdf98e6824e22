// What JavaScript calls: a request as JSON and bytes in, a reply as JSON and blobs out. One at a time.
#include <cstdint>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <emscripten/em_js.h>
#include <emscripten/emscripten.h>

#include <burnish/short_message.h>

#include "verbs.h"

EM_JS(void, burnish_progress, (const char* stage, double fraction), {
  if (Module.progress) Module.progress(UTF8ToString(stage), fraction);
});

namespace {

std::vector<std::byte> buffer;
burnish::wasm::Reply reply;

}  // namespace

extern "C" {

/// Memory for the bytes of the next call; null where there is none.
EMSCRIPTEN_KEEPALIVE std::byte* burnish_buffer(std::size_t size) {
  try {
    buffer = std::vector<std::byte>(size);
    return buffer.data();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

/// 1 where there is a reply, 0 where burnish_text is an error's one line.
EMSCRIPTEN_KEEPALIVE int burnish_call(const char* request) {
  try {
    reply = {};
    reply = burnish::wasm::run(
        {.arguments = burnish::wasm::Json::parse(request), .bytes = std::exchange(buffer, {})},
        [caller = std::this_thread::get_id()](std::string_view stage, double fraction) {
          // other threads know no JavaScript to tell
          if (std::this_thread::get_id() == caller) burnish_progress(std::string(stage).c_str(), fraction);
        });
    return 1;
  } catch (const std::bad_alloc&) {
    reply.json = "expected enough memory, found none left";
  } catch (const std::exception& error) {
    reply.json = burnish::short_message(error.what());
  }
  buffer = {};
  return 0;
}

EMSCRIPTEN_KEEPALIVE const char* burnish_text() {
  return reply.json.c_str();
}

EMSCRIPTEN_KEEPALIVE std::size_t burnish_blobs() {
  return reply.blobs.size();
}

EMSCRIPTEN_KEEPALIVE const char* burnish_blob(std::size_t i) {
  return reply.blobs[i].data();
}

EMSCRIPTEN_KEEPALIVE std::size_t burnish_blob_size(std::size_t i) {
  return reply.blobs[i].size();
}

/// Gives the reply's memory back.
EMSCRIPTEN_KEEPALIVE void burnish_clear() {
  reply = {};
}

}  // extern "C"
