// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/file.h>

namespace burnish {

/// A row of a CSV file of encodings: a name and its numbers.
struct NamedRow {
  std::string name;
  std::vector<float> numbers;
};

/// The kind of a file's rows, for error messages.
struct NamedRowKind {
  std::size_t count;         ///< count of the numbers in a row
  std::string_view number;   ///< name of one number, such as "weight"
  std::string_view a_row;    ///< name of a row, such as "encoding"
  std::string_view address;  ///< address of one row of several, such as "nbrdf:FILE#NAME"
};

/// Returns the row named `name`, or the only row if `name` is empty. Throws Error if a row up to it is anything else.
/// Throws Error if there is no such row (the message lists names), or if there are several and `name` is empty.
NamedRow parse_named_row(const FileBytes& file, std::string_view name, const NamedRowKind& kind);

}  // namespace burnish
