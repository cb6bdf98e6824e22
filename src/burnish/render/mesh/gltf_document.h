// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/math/vec3.h>

namespace burnish {

/// The elements of an accessor as numbers.
struct GltfElements {
  std::size_t count = 0, width = 0;
  std::vector<double> values;

  Vec3 vec3(std::size_t i) const noexcept { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }
};

/// The JSON of a glTF file and the numbers in its buffers. Errors name the file and the place in the JSON.
/// Only for gltf.cpp: it includes nlohmann/json.
class GltfDocument {
 public:
  /// Refers to the file's bytes. Throws Error, with the offset, for what is no glTF.
  GltfDocument(const FileBytes& file, const std::filesystem::path& folder);

  const nlohmann::json& root() const noexcept { return root_; }
  [[noreturn]] void fail(const std::string& place, const std::string& expected,
                         const std::string& found) const;
  /// of[key]; throws Error where it is missing.
  const nlohmann::json& member(const nlohmann::json& of, const char* key, const std::string& place) const;
  /// An integer below `below`; throws Error for anything else.
  std::size_t number(const nlohmann::json& value, const std::string& place, std::size_t below) const;
  std::size_t number_or(const nlohmann::json& of, const char* key, std::size_t otherwise,
                        const std::string& place, std::size_t below) const;
  /// Element i of a list of the root; throws Error unless it is an object.
  const nlohmann::json& element(const char* list, std::size_t i) const;
  /// Returns the elements of accessor `index`. Throws Error where it does not fit its buffer or is not supported.
  GltfElements elements(std::size_t index, const std::string& user);

 private:
  std::string_view split_binary(std::string_view text);
  std::string_view buffer(std::size_t index);
  std::vector<std::byte> load(const nlohmann::json& uri, const std::string& place) const;

  std::string name_;
  std::filesystem::path folder_;
  nlohmann::json root_;
  std::string_view chunk_;  // of a binary file
  std::vector<std::vector<std::byte>> buffers_;
};

}  // namespace burnish
