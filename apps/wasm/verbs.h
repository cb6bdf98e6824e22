#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace burnish::wasm {

using Json = nlohmann::ordered_json;

/// What a caller asks for: {"verb": ..., "id": ..., ...}, and bytes that belong to it.
struct Request {
  Json arguments;
  std::vector<std::byte> bytes;
};

/// What it gets: JSON and binary parts.
struct Reply {
  std::string json = "null";
  std::vector<std::string> blobs;
};

/// Called with a stage and a rising share of it.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Does what the request's verb says to the materials that were opened, which live until they are closed. Throws
/// burnish::Error for a verb or a material that there is none of, and as the library does.
Reply run(Request request, const Progress& progress);

}  // namespace burnish::wasm
