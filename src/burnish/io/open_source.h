#pragma once

#include <string>

#include <burnish/file.h>
#include <burnish/io/open_options.h>
#include <burnish/source.h>

namespace burnish {

/// Opens an analytic BRDF such as "ggx:alpha_x=0.1" (see parse_analytic), a neural encoding "nbrdf:FILE#NAME" (see
/// parse_neural) or "np:PLACE#NAME" (see open_np), a material of a book "book:FILE#NAME" (book/book_file.h), a texel
/// of a surface in its own frame "surface:FILE#COLUMN,ROW" (surface/surface_file.h), or a file, whose kind is found by
/// content, never by its name. Throws Error if it cannot be read or is of no known
/// kind, and whatever its reader throws.
Source open_source(const std::string& spec, const OpenOptions& options);

/// The same for bytes in memory.
Source parse_source(const FileBytes& file, const OpenOptions& options);

/// Whether the bytes are of a kind that parse_source knows, by their content: false of a text that is no measurement,
/// a picture, a list. What is of a known kind and broken is true.
bool looks_like_source(const FileBytes& file);

}  // namespace burnish
