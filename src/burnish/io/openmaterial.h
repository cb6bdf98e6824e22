// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// Returns true if the text is a JSON object that names a lookupTable within its first 64 KiB.
bool looks_like_openmaterial(std::string_view text) noexcept;

/// Reads the look-up table of ASAM OpenMATERIAL 3D, a `.xompt`. The JSON has brdf.wavelengths in metres and rows
/// [wavelength, theta_i, theta_o, phi_o - phi_i, f_r] of brdf.lookupTable, in radians and 1/sr. Samples are scattered
/// and isotropic. Directions that lack a wavelength, or hold null, are counted as holes and left out. A single
/// wavelength stays one channel. The metadata's authors and licence become the findings' origin.
///
/// Throws Error unless every row has its five numbers, its wavelength is in the list, angles are in range and no row
/// comes twice. The reader was checked against the schema of version 1.0.0 and its examples for cameras and lidar,
/// whose retroreflection stands at azimuth 0. Source: [ASAM 2025].
SampleFile parse_openmaterial(const FileBytes& file, const OpenOptions& options);

struct OpenMaterialText {
  std::string text;
  std::size_t averaged = 0;  ///< samples without a row of their own: another sample has their angles
};

/// Returns the text that parse_openmaterial reads back to the same isotropic samples, sorted as the schema demands.
/// Values and angles have all their digits, but angles beyond the schema's pi/2 = 1.570796 are set to it. Negative
/// values become 0, the schema's least; samples whose angles are then equal are averaged. `lambda_nm` has one
/// wavelength for each channel. The identifier is made from the content. Members that `origin` leaves empty are
/// "unknown" in the file; empty sources become "converted by burnish". Throws Error if the samples are anisotropic or
/// `lambda_nm` has another count than the channels.
OpenMaterialText format_openmaterial(const Samples& samples, std::span<const double> lambda_nm,
                                     std::string_view name, const Origin& origin = {});

}  // namespace burnish
