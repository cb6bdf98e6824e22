// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/library/material_record.h>

namespace burnish {

inline constexpr std::string_view kCataloguePage = "index.html";

/// Writes FOLDER/index.html and FOLDER/page/, static files that show all materials of a batch (web/catalogue): their
/// pictures on sheets, their figures, and parts with the models themselves, which links to `studio`, an address as from
/// the page, carry behind their #. Models and pictures are read from the folder, some at a time; a baseline, a model that
/// is too large for a link and what failed have none. Throws Error where that cannot be done.
/// Returns the files' paths below the folder.
std::vector<std::string> write_catalogue(const std::filesystem::path& folder,
                                         std::span<const MaterialRecord> records, const std::string& studio);

}  // namespace burnish
