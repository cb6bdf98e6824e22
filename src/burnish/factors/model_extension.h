// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <burnish/factors/model_file.h>

namespace burnish {

/// One part of a model's OpenEXR file: a picture of one to three channels, or of a table.
struct ExrPart {
  std::string name;
  int width = 0, height = 0;
  std::size_t channels = 1;
  bool half = false;          ///< how values are stored, else floats
  std::vector<float> values;  ///< [row][column][channel]
};

/// The longest side of a part that is no table.
inline constexpr int kMaxPartSide = 16'384;

/// The surface that a model is part of (surface/surface_file.h): JSON that says so, and pictures.
struct ModelExtension {
  std::string json;
  std::vector<ExrPart> parts;
};

/// A model's OpenEXR file (model_file.h) with parts more behind the tables, and JSON that describes them in another
/// attribute of the first part, "burnish_surface". Throws as format_model does, and where a table has a part's name.
std::string format_extended_model(const Model& model, ModelExtension extension);

struct ExtendedModel {
  Model model;
  ModelExtension extension;
};
/// Reads such a file; `parts_of` names, by the JSON, the parts that have to be there, without values. Throws Error as
/// parse_model does, and where the JSON is missing or parts are others.
ExtendedModel parse_extended_model(
    const FileBytes& file, const std::function<std::vector<ExrPart>(const std::string& json)>& parts_of);

/// True if the bytes start as such a file does; they have to hold the first part's header.
bool looks_like_extended_model(std::span<const std::byte> head) noexcept;

}  // namespace burnish
