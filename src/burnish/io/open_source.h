// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/file.h>
#include <burnish/io/open_options.h>
#include <burnish/source.h>

namespace burnish {

/// Opens a source. `spec` is one of these:
/// - an analytic BRDF such as "ggx:alpha_x=0.1" (see parse_analytic);
/// - a neural encoding "nbrdf:FILE#NAME" (see parse_neural) or "np:PLACE#NAME" (see open_np);
/// - a material of a book "book:FILE#NAME" (book/book_file.h);
/// - a texel of a surface in its own frame "surface:FILE#COLUMN,ROW" (surface/surface_file.h);
/// - a file, whose kind is found by its content, never by its name.
///
/// Throws Error if the source cannot be read or is of no known kind, and whatever its reader throws.
Source open_source(const std::string& spec, const OpenOptions& options);

/// Opens the bytes of a file in memory, as open_source opens a file.
Source parse_source(const FileBytes& file, const OpenOptions& options);

/// Returns true if parse_source knows the kind of the bytes by their content, even if they are broken. Returns false
/// for a text that is no measurement, a picture and a list.
bool looks_like_source(const FileBytes& file);

}  // namespace burnish
