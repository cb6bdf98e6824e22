#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/bsdf_part.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// Returns the place among a file's `blocks`, at least one, of the one that is read.
/// - The part is the one asked for, else a reflection where there is one, the front's first (the back's with
///   OpenOptions::back_side), else the transmission, the front's first.
/// - The band is the one asked for, in any case, else the visible one (Visible, CIE-Y, one without a name), else the
///   first; of several parts one that has the band.
/// Throws Error in one line, naming what there is, where the file has not what is asked for.
std::size_t choose_block(const std::string& file, std::span<const BsdfBlock> blocks,
                         const OpenOptions& options);

/// Throws Error, naming the part there is, where the options ask for a part or a band that a source of a format without
/// a choice is not.
void check_block(const std::string& file, const Findings& findings, const OpenOptions& options);

/// Notes the blocks of a file and the one that was read. A transmission that nobody asked for is a warning.
void note_blocks(std::span<const BsdfBlock> blocks, std::size_t chosen, const OpenOptions& options,
                 Findings& findings);

}  // namespace burnish
