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

/// One reflection matrix of a window system's XML file: "Reflection Front", or "Reflection Back" if asked; of
/// the visible spectrum where there are several. Columns are incident patches, counted by the azimuth
/// the light travels to: the mirror direction has the same patch. Grey; continuous between patch
/// centres. Negatives are counted and kept. Throws Error if the matrix is
/// missing, not patches of stated rings (variable resolution trees are not read), not as large as its bases,
/// or a value is not finite.
KlemsFile parse_klems(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
