// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/io/byte_reader.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/function_brdf.h>

namespace burnish {

struct FourierFile {
  FunctionBrdf brdf;
  Findings findings;
};

/// Returns true if the bytes start with "SCATFUN".
bool looks_like_fourier(std::span<const std::byte> bytes) noexcept;

/// Reads the reflection of the upper side of a Fourier BSDF, as layerlab writes and pbrt-v3 reads it (`fourier`, often
/// `.bsdf`). Each pair of cosines mu_i = -wi.z and mu_o = wo.z has a cosine series of the azimuth between -wi and wo.
/// Its value is f_r |mu_i|. Catmull-Rom splines interpolate between the cosines. The material is isotropic, and grey or
/// linear Rec. 709 (the file stores luminance, red and blue). Values below zero become zero, as in pbrt.
///
/// A file is little-endian: 64 bytes of header, mu, a table for sampling, offset and length of each series,
/// coefficients, remarks. The table for sampling is passed over. The reader takes memory in proportion to the file.
///
/// Throws Error if sizes and length differ, a number is not finite, or cosines do not rise from -1 to 1. Throws Error
/// if a series lies outside the coefficients, or nothing is reflected. Throws Error too for textures and harmonic
/// extrapolation, which pbrt-v3 cannot read either. Source: [Jakob 2014].
FourierFile parse_fourier(const FileBytes& file);

}  // namespace burnish
