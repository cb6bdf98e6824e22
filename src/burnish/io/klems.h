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

/// One reflection matrix of a window system's XML file: "Reflection Front", or "Reflection Back" if asked, the other
/// where a file has that one alone; of the visible spectrum where there are several. What else there is stands in
/// Findings::left_out: transmission, other bands, colours. Columns (or rows, as the file says) are incident patches,
/// counted by the azimuth the light travels to: the mirror direction has the same patch. Grey; constant over
/// patches. Names are of any case. Negatives are counted and kept. Throws Error if the matrix is missing, not patches
/// of stated rings or a Klems basis, not as large as its bases, or a value is not finite.
KlemsFile parse_klems(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
