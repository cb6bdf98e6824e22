// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <burnish/baselines/np_brdf.h>
#include <burnish/file.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// A material of a Neural Processes model, read from its two files.
struct NpFile {
  std::string name;  ///< name of the material
  NpBrdf brdf;
  Findings findings;
};

/// Returns true if the first line is a name and the numbers of a code. A code alone is no BRDF: its decoder
/// is another file.
bool looks_like_np(std::string_view text) noexcept;

/// Reads a decoder: the weights of an NpDecoder as little-endian floats. Throws Error if the size is another
/// or NpDecoder refuses a weight.
std::shared_ptr<const NpDecoder> parse_np_decoder(const FileBytes& file);

/// Reads one code of a CSV file whose rows are a name and NpBrdf::kCode numbers, and joins it with its
/// decoder. The row is the one named `name`, or the only one if `name` is empty. Names that end in "_rgb" are
/// materials of the RGL database, whose values were trained times the cosine; all others decode to f_r.
/// Throws Error as parse_named_row and NpBrdf do. Layout: [Zheng 2021].
NpFile parse_np(const FileBytes& codes, std::string_view name, std::shared_ptr<const NpDecoder> decoder);

/// Opens "PLACE#NAME", or "PLACE" if there is one code alone. PLACE is a file of codes, or a folder that holds it as
/// codes.csv. The decoder lies beside it as decoder.f32. Throws Error as read_file and the parsers do.
NpFile open_np(std::string_view address);

}  // namespace burnish
