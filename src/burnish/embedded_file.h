#pragma once

#include <span>
#include <string_view>

namespace burnish {

/// A text file that cmake/EmbedFiles.cmake made a part of the program.
struct EmbeddedFile {
  std::string_view name, text;
};

/// The text of the file of that name. Throws std::logic_error where there is none.
std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name);

}  // namespace burnish
