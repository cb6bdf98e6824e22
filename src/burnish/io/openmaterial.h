#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// True if the text is a JSON object that names a lookupTable within its first 64 KiB.
bool looks_like_openmaterial(std::string_view text) noexcept;

/// The look-up table of ASAM OpenMATERIAL 3D, a `.xompt`: JSON with brdf.wavelengths in metres and rows
/// [wavelength, theta_i, theta_o, phi_o - phi_i, f_r] of brdf.lookupTable, radians and 1/sr. Isotropic scattered
/// samples; directions that lack a wavelength, or hold null, are counted as holes and left out. A single
/// wavelength stays one channel. metadata's authors and licence are the findings' origin. Throws Error unless every
/// row has its five numbers, its wavelength is in the list, angles are in range and no row comes twice.
/// Checked against the schema of version 1.0.0 and its examples for cameras and lidar, whose retroreflection stands at
/// azimuth 0. Source: [ASAM 2025].
SampleFile parse_openmaterial(const FileBytes& file, const OpenOptions& options);

struct OpenMaterialText {
  std::string text;
  std::size_t averaged = 0;  ///< samples whose angles another one has, so that no row of their own is left
};

/// The text that parse_openmaterial reads back to the same isotropic samples, sorted as the schema asks, values and
/// angles with all their digits (angles beyond the schema's pi/2 = 1.570796 are set to it); negative values become 0,
/// which is the schema's least, and samples of then equal angles are averaged. `lambda_nm` has one wavelength a channel;
/// the identifier is made from the content. What `origin` does not say is "unknown" in the file, its sources "converted
/// by burnish". Throws Error if the samples are anisotropic or the wavelengths are not one a channel.
OpenMaterialText format_openmaterial(const Samples& samples, std::span<const double> lambda_nm,
                                     std::string_view name, const Origin& origin = {});

}  // namespace burnish
