#pragma once

#include <burnish/io/byte_reader.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/function_brdf.h>

namespace burnish {

struct FourierFile {
  FunctionBrdf brdf;
  Findings findings;
};

/// True if the bytes start with "SCATFUN".
bool looks_like_fourier(std::span<const std::byte> bytes) noexcept;

/// The reflection of the upper side of a Fourier BSDF, as layerlab writes and pbrt-v3 reads it (`fourier`, often
/// `.bsdf`): for each pair of cosines mu_i = -wi.z and mu_o = wo.z a cosine series of the azimuth between -wi and wo,
/// whose value is f_r |mu_i|; Catmull-Rom splines between the cosines. Isotropic, grey or linear Rec. 709 (luminance,
/// red and blue are stored). Values below zero become zero, as in pbrt. Little-endian: 64 bytes of header, mu, a table
/// for sampling, which is passed over, offset and length of each series, coefficients, remarks. Takes memory in
/// proportion to the file. Throws Error where sizes and length differ, a number is not finite, cosines do not rise from
/// -1 to 1, a series lies outside the coefficients, there is no reflection, or the file has what pbrt-v3 cannot read
/// either: textures and harmonic extrapolation. Source: [Jakob 2014].
FourierFile parse_fourier(const FileBytes& file);

}  // namespace burnish
