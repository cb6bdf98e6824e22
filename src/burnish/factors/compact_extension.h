// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include <burnish/factors/cbor.h>
#include <burnish/factors/model_file.h>

namespace burnish {

/// A compact file (compact_file.h) with one item more behind the notes, which says what a model is part of: a surface
/// (surface/surface_file.h). `append` writes that item. Throws as format_compact does.
std::string format_compact_with(const Model& model, const std::function<void(CborWriter&)>& append);

/// Reads such a file: `read` the item, given the model before it. Throws Error as parse_compact does, and where there
/// is no such item.
Model parse_compact_with(const FileBytes& file, const std::function<void(CborReader&, const Model&)>& read);

/// True if the bytes start as such a file does.
bool looks_like_extended_compact(std::span<const std::byte> head) noexcept;

}  // namespace burnish
