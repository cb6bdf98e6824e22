// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// Returns true if a line within the first 64 KiB starts with VARS.
bool looks_like_astm(std::string_view text) noexcept;

/// Reads scattered samples in the text format of ASTM E1392: a header of keys and values up to the line "VARS
/// theta_i,phi_i,theta_s,phi_s,NAME...", then one row for each measurement, angles in radians. One NAME is grey, three
/// are red, green and blue, numbers are wavelengths in nm. A VARS line without phi_s is accepted if the rows have the
/// column. Values are f_r unless a name says another kind, as CCBRDF does (value_kind.h). The material is anisotropic
/// unless every sample has the same phi_i. Throws Error on anything else. Source: [ASTM 1996].
SampleFile parse_astm(const FileBytes& file, const OpenOptions& options);

/// Returns the text that parse_astm reads back to the same samples, angles with all their digits. Isotropic
/// samples are turned to phi_i = 0, by which a reader recognizes them. `lambda_nm` names the columns of
/// spectra. Throws Error if channels have no names.
std::string samples_astm(const Samples& samples, std::span<const double> lambda_nm = {});

}  // namespace burnish
