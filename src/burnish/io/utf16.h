#pragma once

#include <optional>

#include <burnish/file.h>

namespace burnish {

/// The same text in UTF-8, under the same name, of a file in UTF-16 with a byte order mark at its front, as
/// spreadsheets write it; nothing of any other file, and where a half of a pair stands alone or a character is 0.
std::optional<FileBytes> from_utf16(const FileBytes& file);

}  // namespace burnish
