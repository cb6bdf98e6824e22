// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/patch_table.h>

namespace burnish {

struct KlemsFile {
  PatchTable table;
  Findings findings;
};

/// Returns true if the text is XML with a WindowElement.
bool looks_like_klems(std::string_view text) noexcept;

/// Reads one matrix of a window system's XML file: the part and band that choose_block finds for the options. All
/// blocks stand in Findings::blocks, and blocks that were not read in Findings::left_out too.
///
/// Columns (or rows, if the file says so) are incident patches, numbered by the azimuth that the light travels to. So
/// the mirror direction has the same patch, and for transmission the direction straight on has it. Values are grey, in
/// the band CIE-XYZ linear Rec. 709, and constant over patches. Names are of any case. Negative values are counted and
/// kept.
///
/// Throws Error if the block is missing, or its basis is neither patches of stated rings nor a Klems basis. Throws
/// Error if the matrix is not as large as its bases, or a value is not finite. Values of all four parts agree with
/// those of Radiance (tests/bsdf).
KlemsFile parse_klems(const FileBytes& file, const OpenOptions& options);

/// A matrix and the block that it becomes.
struct PatchBlock {
  const PatchTable* table;
  BsdfBlock block;
};

/// Returns the file that holds the matrices, as columns. Bases that Radiance and WINDOW know have their names, and all
/// are stated ring by ring. Reading the file back gives the same matrices, every value to its last bit. Preconditions:
/// there is a matrix, each has one channel, and incident azimuths count from pi, as parse_klems has them.
std::string format_klems(std::span<const PatchBlock> blocks, std::string_view material);

}  // namespace burnish
