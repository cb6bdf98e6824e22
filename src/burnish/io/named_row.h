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

/// What a file's rows are, for errors.
struct NamedRowKind {
  std::size_t count;         ///< of numbers
  std::string_view number;   ///< what one is called, such as "weight"
  std::string_view a_row;    ///< what a row is, such as "encoding"
  std::string_view address;  ///< how one of several is named, such as "nbrdf:FILE#NAME"
};

/// The row named `name`, or the only one where `name` is empty. Throws Error if a row up to it is anything
/// else, if there is no such row (the message lists names), or if there are several and `name` is empty.
NamedRow parse_named_row(const FileBytes& file, std::string_view name, const NamedRowKind& kind);

}  // namespace burnish
