// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace burnish::wasm {

using Json = nlohmann::ordered_json;

/// A request {"verb": ..., "id": ..., ...}, and bytes that belong to it.
struct Request {
  Json arguments;
  std::vector<std::byte> bytes;
};

/// The reply: JSON and binary parts.
struct Reply {
  std::string json = "null";
  std::vector<std::string> blobs;
};

/// Progress is called with a stage and the rising share of it that is done.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Does the request's verb with the opened materials, which live until they are closed. Throws burnish::Error for an
/// unknown verb or material, and as the library does.
Reply run(Request request, const Progress& progress);

}  // namespace burnish::wasm
