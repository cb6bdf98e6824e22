// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace burnish {

/// A text file that cmake/EmbedFiles.cmake made a part of the program.
struct EmbeddedFile {
  std::string_view name, text;
};

/// The text of the file of that name. Throws std::logic_error where there is none.
std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name);

/// A text whose marks, @ and capital letters, are replaced by what `marks` has under those letters; what is put in is
/// not searched. Throws std::logic_error on a mark of the text that `marks` lacks.
std::string with_marks(std::string_view text, const std::map<std::string_view, std::string>& marks);

}  // namespace burnish
