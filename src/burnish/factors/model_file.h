// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/file.h>

namespace burnish {

/// A factored BRDF with what its file says about it.
struct Model {
  FactoredBrdf brdf;
  std::vector<double> lambda_nm;  ///< wavelengths of the channels; empty for grey and RGB
  std::string notes = "{}";       ///< a JSON object: source, fit options, errors

  friend bool operator==(const Model&, const Model&) = default;
};

/// The native file: a multi-part OpenEXR image, one part a table in the table's name, and in the first part a string
/// attribute "burnish" with JSON: version, channels, tables with their formats, lobes, notes. A volume's layers stand
/// one under another. Pixels are halves where halves hold the table's format exactly (half, rgb9e5), else floats, so
/// that any viewer shows the tables. parse_model restores the model to the last bit.
std::string format_model(const Model& model);

/// The bytes of a model's file by the ending of its name: format_compact's (compact_file.h) for .burnish,
/// else format_model's.
std::string format_model_as(const std::filesystem::path& name, const Model& model);

/// Reads either file of a model, known by its content. Throws Error as parse_compact (compact_file.h) does,
/// or if the bytes are no OpenEXR file, hold no "burnish" attribute, or contradict it in any way: values that
/// a table's stated format does not hold are refused too, so that bytes() is the truth. Files of version 1,
/// with one format for all tables, are read as well.
Model parse_model(const FileBytes& file);

/// True if the bytes start as an OpenEXR or a compact file does.
bool looks_like_model(std::span<const std::byte> head) noexcept;

/// True if the bytes start as an OpenEXR file does.
bool looks_like_exr(std::span<const std::byte> head) noexcept;

}  // namespace burnish
