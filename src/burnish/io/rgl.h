// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/rgl_table.h>

namespace burnish {

/// A material of the RGL database.
struct RglFile {
  RglTable table;
  Findings findings;
};

/// Returns true if `head`, the first bytes of a file, starts a tensor file.
bool looks_like_rgl(std::span<const std::byte> head) noexcept;

/// Reads a tensor file with the fields of the RGL material database [Dupuy 2018]: isotropic or anisotropic,
/// RGB or spectral. Spectra become linear Rec. 709 under options.illuminant unless options.keep_spectral.
/// Negative values that remain are kept and counted. Throws Error as parse_tensor_file and RglTable do, and
/// for a field that is missing or has another type or shape.
RglFile parse_rgl(const FileBytes& file, const OpenOptions& options);

/// Returns the file that holds `table`; reading it back gives the same values to the last bit. A grey table
/// is written as RGB.
std::string format_rgl(const RglTable& table);

}  // namespace burnish
