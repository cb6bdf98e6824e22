#pragma once

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

/// True if the text is XML with a WindowElement.
bool looks_like_klems(std::string_view text) noexcept;

/// One matrix of a window system's XML file: the part and band that the options ask for, see choose_block. All blocks
/// stand in Findings::blocks, those not read in Findings::left_out too. Columns (or rows, as the file says) are
/// incident patches, counted by the azimuth the light travels to: the mirror direction, and for transmission the
/// direction straight on, has the same patch. Grey, the band CIE-XYZ linear Rec. 709; constant over patches. Names are
/// of any case. Negatives are counted and kept. Throws Error if the block is missing, not patches of stated rings or a
/// Klems basis, not as large as its bases, or a value is not finite. Values of all four parts agree with those of
/// Radiance (tests/bsdf).
KlemsFile parse_klems(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
