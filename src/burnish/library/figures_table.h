// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include <burnish/library/material_record.h>

namespace burnish {

inline constexpr std::string_view kFiguresTable = "library.sqlite";

/// Writes FOLDER/library.sqlite, an SQLite database with one table, `materials`, a row a record: name, path (the
/// argument), file (of the model, below the folder), format, model, bytes, fetches, psnr (dB), ssim, relative,
/// rms_log, log_cos, albedo, warnings (joined by "; "), reason (why it failed; NULL where it did not), seconds, key.
/// Unknown figures are NULL. It is written under another name and renamed. Throws Error where that cannot be done.
void write_figures_table(const std::filesystem::path& folder, std::span<const MaterialRecord> records);

}  // namespace burnish
