// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// Returns true if a '#' line in front of the data starts with #DIM or #PARAM_IN.
bool looks_like_alta(std::string_view text) noexcept;

/// Reads scattered samples in the text format of the ALTA library: '#' lines of keys, then rows of coordinates and
/// values. Where #VS says so, intervals follow the values; they are passed over. #DIM has the numbers of coordinates
/// and values, #PARAM_IN the kind of coordinates.
///
/// The kinds that determine both directions are read: RUSIN_TH_TD_PD, RUSIN_TH_PH_TD, RUSIN_TH_PH_TD_PD,
/// SPHERICAL_TL_PL_TV_PV, ISOTROPIC_TV_TL_DPHI, ISOTROPIC_TL_TV_PROJ_DPHI, SCHLICK_TL_TK_PROJ_DPHI,
/// RETRO_TL_TVL_PROJ_DPHI, STARK_3D, NEUMANN_3D, STEREOGRAPHIC and CARTESIAN. The light is wi, the view is wo. Kinds
/// with three coordinates are isotropic, except RUSIN_TH_PH_TD. Values of #PARAM_OUT INV_STERADIAN_COSINE_FACTOR are
/// divided by cos theta_o. One value is grey, three are RGB. Throws Error if a row has too few coordinates or the
/// values are of another kind. Throws Error too if the coordinates are not two directions of the upper hemisphere.
///
/// The reader was checked against params.h and params.cpp of ALTA and against the retroreflective tape of its data. It
/// follows ALTA's to_cartesian with two exceptions. For STEREOGRAPHIC, to_cartesian is not the inverse of
/// from_cartesian; the reader takes the inverse. For RETRO_TL_TVL_PROJ_DPHI beyond the normal, the cosine of the view's
/// azimuth keeps its sign. Source: [Belcour 2014].
SampleFile parse_alta(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
