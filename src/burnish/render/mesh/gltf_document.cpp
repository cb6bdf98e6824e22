// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/mesh/gltf_document.h>
#include <burnish/render/mesh/mesh_file.h>

namespace burnish {

namespace {

using nlohmann::json;

// Six bits a character, highest first; `=` at the end only fills up.
std::vector<std::byte> from_base64(std::string_view text, const std::string& name, const std::string& place) {
  std::vector<std::byte> bytes;
  unsigned bits = 0, held = 0;  // the last `held` bits of `bits` wait to make a byte
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
    if (!upper && !lower && !digit && c != '+' && c != '/')
      throw Error::in_file(name, place + ": base64",
                           fmt::format("byte 0x{:02x}", static_cast<unsigned char>(c)));
    const int value = upper ? c - 'A' : lower ? c - 'a' + 26 : digit ? c - '0' + 52 : c == '+' ? 62 : 63;
    bits = bits << 6 | static_cast<unsigned>(value);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> held & 0xff));
  }
  return bytes;
}

}  // namespace

GltfDocument::GltfDocument(const FileBytes& file, const std::filesystem::path& folder)
    : name_(file.name), folder_(folder) {
  std::string_view text = file.text();
  std::uint64_t offset = 0;  // of the JSON in the file
  if (text.starts_with("glTF")) {
    offset = 20;
    text = split_binary(text);
  }
  try {
    root_ = json::parse(text);
  } catch (const json::parse_error& error) {
    throw Error(name_, offset + error.byte, "JSON of glTF", "other text");
  }
}

void GltfDocument::fail(const std::string& place, const std::string& expected,
                        const std::string& found) const {
  std::string shown = found.substr(0, 60);
  for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
  throw Error::in_file(name_, place + ": " + expected, shown);
}

// A binary glTF: a header (magic, version, length), then chunks of a length, a type and bytes: first JSON, then
// the buffer that has no uri. Sets chunk_; returns the JSON.
std::string_view GltfDocument::split_binary(std::string_view text) {
  const auto word = [&](std::size_t at) {
    if (text.size() < at + 4) throw Error(name_, at, "4 bytes of a binary glTF", "the end");
    std::uint32_t value = 0;
    std::memcpy(&value, text.data() + at, 4);
    return value;
  };
  if (word(4) != 2) throw Error(name_, 4, "version 2", std::to_string(word(4)));

  // the JSON
  const std::size_t size = word(12);
  if (word(16) != 0x4e4f534a) throw Error(name_, 16, "a chunk of JSON", fmt::format("0x{:x}", word(16)));
  if (size > text.size() - 20)
    throw Error(name_, 12, fmt::format("at most {} bytes of JSON", text.size() - 20), std::to_string(size));

  // the buffer, which may be missing
  const std::string_view rest = text.substr(20 + size);
  if (!rest.empty()) {
    const std::size_t at = 20 + size, length = word(at);
    if (word(at + 4) != 0x004e4942)
      throw Error(name_, at + 4, "a binary chunk", fmt::format("0x{:x}", word(at + 4)));
    if (length > rest.size() - 8)
      throw Error(name_, at, fmt::format("at most {} bytes", rest.size() - 8), std::to_string(length));
    chunk_ = rest.substr(8, length);
  }
  return text.substr(20, size);
}

const json& GltfDocument::member(const json& of, const char* key, const std::string& place) const {
  if (!of.is_object() || !of.contains(key)) fail(place, fmt::format("'{}'", key), "none");
  return of[key];
}
std::size_t GltfDocument::number(const json& value, const std::string& place, std::size_t below) const {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= below)
    fail(place, fmt::format("an integer below {}", below), value.dump());
  return value.get<std::size_t>();
}
std::size_t GltfDocument::number_or(const json& of, const char* key, std::size_t otherwise,
                                    const std::string& place, std::size_t below) const {
  const auto found = of.find(key);
  return found == of.end() ? otherwise : number(*found, place + "." + key, below);
}
const json& GltfDocument::element(const char* list, std::size_t i) const {
  const json& all = member(root_, list, "the file");
  const std::string place = fmt::format("{}[{}]", list, i);
  if (!all.is_array() || i >= all.size() || !all[i].is_object()) fail(place, "an object", "none");
  return all[i];
}

std::string_view GltfDocument::buffer(std::size_t index) {
  const std::string place = fmt::format("buffers[{}]", index);
  const json& entry = element("buffers", index);
  if (buffers_.size() <= index) buffers_.resize(index + 1);
  const std::size_t length = number(member(entry, "byteLength", place), place + ".byteLength", SIZE_MAX);
  // the binary chunk, or what the uri names, loaded once
  std::string_view bytes;
  if (!entry.contains("uri")) {
    if (index != 0 || chunk_.empty()) fail(place, "a uri", "none");
    bytes = chunk_;
  } else {
    if (buffers_[index].empty()) buffers_[index] = load(entry["uri"], place);
    bytes = {reinterpret_cast<const char*>(buffers_[index].data()), buffers_[index].size()};
  }
  if (bytes.size() < length) fail(place, fmt::format("{} bytes", length), std::to_string(bytes.size()));
  return bytes.substr(0, length);
}
std::vector<std::byte> GltfDocument::load(const json& uri, const std::string& place) const {
  if (!uri.is_string()) fail(place + ".uri", "a string", uri.dump());
  const std::string text = uri.get<std::string>();
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(";base64,");
    if (comma == text.npos) fail(place + ".uri", "data as base64", text);
    return from_base64(std::string_view(text).substr(comma + 8), name_, place);
  }
  // never leaves the file's folder
  const std::filesystem::path path(text);
  if (path.is_absolute() || text.find("..") != text.npos || text.find(':') != text.npos)
    fail(place + ".uri", "a file beside this one", text);
  return read_file(folder_ / path, std::uint64_t{1} << 31).bytes;
}

GltfElements GltfDocument::elements(std::size_t index, const std::string& user) {
  // the type of an element: how many numbers of which kind
  const json& accessor = element("accessors", index);
  const std::string place = fmt::format("{}: accessors[{}]", user, index);
  if (accessor.contains("sparse")) fail(place, "an accessor that is not sparse", "a sparse one");
  const json& type = member(accessor, "type", place);
  constexpr std::string_view kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto known = std::ranges::find(kTypes, type.is_string() ? type.get<std::string>() : "");
  if (known == std::end(kTypes)) fail(place + ".type", "SCALAR or VEC2 to VEC4", type.dump());
  GltfElements e;
  e.width = static_cast<std::size_t>(known - std::begin(kTypes)) + 1;
  const std::size_t kind = number(member(accessor, "componentType", place), place + ".componentType", 5127);
  const std::size_t bytes = kind == 5121 ? 1 : kind == 5123 ? 2 : kind == 5125 || kind == 5126 ? 4 : 0;
  if (bytes == 0) fail(place + ".componentType", "5121, 5123, 5125 or 5126", std::to_string(kind));

  // where its bytes lie: the accessor in a view in a buffer, each inside the one around it
  e.count = number(member(accessor, "count", place), place + ".count", 3 * kMaxTriangles + 1);
  const json& view =
      element("bufferViews", number(member(accessor, "bufferView", place), place + ".bufferView", SIZE_MAX));
  const std::string_view all = buffer(number(member(view, "buffer", place), place + ".buffer", 1000));
  const std::size_t view_start = number_or(view, "byteOffset", 0, place, all.size() + 1);
  const std::size_t view_size =
      number(member(view, "byteLength", place), place + ".byteLength", all.size() - view_start + 1);
  const std::size_t start = number_or(accessor, "byteOffset", 0, place, view_size + 1);
  const std::size_t size = bytes * e.width, step = number_or(view, "byteStride", size, place, 253);
  if (step < size) fail(place + ".byteStride", fmt::format("at least {}", size), std::to_string(step));
  if (e.count > 0 && (view_size - start < size || (view_size - start - size) / step < e.count - 1))
    fail(place, fmt::format("{} bytes of its buffer", (e.count - 1) * step + size),
         std::to_string(view_size - start));

  // integers may stand for [0, 1]
  const bool normalized = accessor.contains("normalized") && accessor["normalized"] == json(true);
  const double scale = normalized && bytes < 4 ? 1.0 / ((1 << 8 * bytes) - 1) : 1;
  e.values.reserve(e.count * e.width);
  for (std::size_t i = 0; i < e.count; ++i)
    for (std::size_t c = 0; c < e.width; ++c) {
      const char* at = all.data() + view_start + start + i * step + c * bytes;
      std::uint32_t integer = 0;
      std::memcpy(&integer, at, bytes);
      float real = 0;
      if (kind == 5126) std::memcpy(&real, at, 4);
      const double value = kind == 5126 ? static_cast<double>(real) : scale * integer;
      if (!(std::abs(value) <= 1e18))
        fail(place, fmt::format("element {} to be finite", i), fmt::format("{}", value));
      e.values.push_back(value);
    }
  return e;
}

}  // namespace burnish
