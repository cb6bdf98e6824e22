// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <burnish/factors/model_file.h>

namespace burnish {

/// The parts of a model that a compact file holds.
enum class CompactContent {
  model,           ///< all that evaluation needs, and lambda_nm; of the notes part and band alone
  model_and_notes  ///< everything
};

/// The compact twin of the native file, `.burnish`: one CBOR item [RFC8949] that holds the form of the model and
/// every table's bytes as `pack` makes them, ready for a texture. docs/guide/formats.md lists it item by item. Above
/// the tables it is at most 256 bytes and 5 % of theirs for what `fit` makes of grey and RGB sources within a budget.
/// Notes would not fit into that: they are left out unless asked for. parse_compact restores the written parts of the
/// model to the last bit, and so do both ways between this file and format_model's. Throws Error if there are more
/// than kMaxCompactItems tables, lobes or factors, or a name or notes are no UTF-8.
std::string format_compact(const Model& model, CompactContent content = CompactContent::model);

/// Throws Error, naming the offset, if the bytes are no such file or contradict themselves in any way; what
/// is left out is an empty JSON object. Memory taken is at most a fixed multiple of the file's size.
Model parse_compact(const FileBytes& file);

/// True if the bytes start as a compact file does: with CBOR's self-described tag and a list whose first item
/// is "burnish".
bool looks_like_compact(std::span<const std::byte> head) noexcept;

/// The most tables, the most lobes, and the most factors of all lobes together.
inline constexpr std::size_t kMaxCompactItems = 4096;

}  // namespace burnish
