// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <burnish/file.h>

namespace burnish {

/// Converts a file in UTF-16 with a byte order mark at its front, as spreadsheets write it, to the same text in UTF-8
/// under the same name. Returns nothing for any other file, for half a surrogate pair and for a character 0.
std::optional<FileBytes> from_utf16(const FileBytes& file);

}  // namespace burnish
