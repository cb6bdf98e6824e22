// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// Returns true if the first line that is no comment is "type bsdf_data".
bool looks_like_fred(std::string_view text) noexcept;

/// Reads scattered samples in the text format of FRED's tabulated scatter models. A file has "type bsdf_data", then a
/// line "format angles=deg bsdf=value scale=1" (angles may be rad). Each specular direction has a line of theta and
/// phi, and under it lines of theta, phi and value. The specular direction is the one into which a mirror sends the
/// light, so the light comes from phi + 180 degrees. Samples are isotropic and grey. Throws Error on anything else,
/// directions below the horizon included. Source: [Photon Engineering 2024].
SampleFile parse_fred(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
