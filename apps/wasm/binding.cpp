// SPDX-License-Identifier: Apache-2.0
// JavaScript calls these functions: a request as JSON and bytes in, a reply as JSON and blobs out. One call runs at a
// time.
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

/// Returns memory for the bytes of the next call, or null where there is none.
EMSCRIPTEN_KEEPALIVE std::byte* burnish_buffer(std::size_t size) {
  try {
    buffer = std::vector<std::byte>(size);
    return buffer.data();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

/// Runs a request. Returns 1 where there is a reply, 0 where burnish_text is an error's one line.
EMSCRIPTEN_KEEPALIVE int burnish_call(const char* request) {
  try {
    reply = {};
    reply = burnish::wasm::run(
        {.arguments = burnish::wasm::Json::parse(request), .bytes = std::exchange(buffer, {})},
        [caller = std::this_thread::get_id()](std::string_view stage, double fraction) {
          // Other threads have no JavaScript function to report to.
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

/// Frees the reply's memory.
EMSCRIPTEN_KEEPALIVE void burnish_clear() {
  reply = {};
}

}  // extern "C"
