// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <burnish/io/convert.h>

namespace burnish {

/// Writers of convert, for the rows of formats.cpp. `losses` lists what the source's file holds and the format has no
/// place for; each writer adds what else is lost. They throw Error if the format cannot hold the source.
using Losses = std::vector<std::string>;
Converted write_merl(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_utia(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_rgl(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_mbsdf(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_zemax(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_tensor_tree(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_klems(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_speos(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_openmaterial(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_astm(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_csv(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_slices(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_model(const Source& source, const ConvertOptions& options, Losses losses);
Converted write_compact(const Source& source, const ConvertOptions& options, Losses losses);

/// Writers of several parts of one surface, for Format::write_parts. There are two parts or more.
Converted write_tensor_tree_parts(std::span<const Source> parts, const ConvertOptions& options,
                                  Losses losses);
Converted write_klems_parts(std::span<const Source> parts, const ConvertOptions& options, Losses losses);
Converted write_speos_parts(std::span<const Source> parts, const ConvertOptions& options, Losses losses);

}  // namespace burnish
