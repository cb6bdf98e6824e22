// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/bsdf_part.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// Returns the index in `blocks`, which holds at least one, of the block to read.
/// - The part is the requested one. Without a request, it is a reflection if there is one, the front's first (the
///   back's with OpenOptions::back_side), and otherwise the transmission, the front's first.
/// - The band is the requested one, in any case. Without a request, it is the visible one (Visible, CIE-Y, one
///   without a name), and otherwise the first. If several parts remain, one that has the band is read.
///
/// Throws Error in one line, naming the blocks of the file, if the file lacks the requested part or band.
std::size_t choose_block(const std::string& file, std::span<const BsdfBlock> blocks,
                         const OpenOptions& options);

/// Checks the options for a format without a choice. Throws Error, naming the part of the source, if they request
/// another part or band.
void check_block(const std::string& file, const Findings& findings, const OpenOptions& options);

/// Notes the blocks of a file and the one that was read. A transmission that the options did not request is a warning.
void note_blocks(std::span<const BsdfBlock> blocks, std::size_t chosen, const OpenOptions& options,
                 Findings& findings);

}  // namespace burnish
