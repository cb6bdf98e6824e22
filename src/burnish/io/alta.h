#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// True if a '#' line in front of the data starts with #DIM or #PARAM_IN.
bool looks_like_alta(std::string_view text) noexcept;

/// Scattered samples in the text format of the ALTA library: '#' lines of keys, then rows of coordinates, values and,
/// where #VS says so, their intervals, which are passed over. #DIM has the numbers of coordinates and values, #PARAM_IN
/// what the coordinates are. Read are those that determine both directions: RUSIN_TH_TD_PD, RUSIN_TH_PH_TD,
/// RUSIN_TH_PH_TD_PD, SPHERICAL_TL_PL_TV_PV, ISOTROPIC_TV_TL_DPHI, ISOTROPIC_TL_TV_PROJ_DPHI,
/// SCHLICK_TL_TK_PROJ_DPHI, RETRO_TL_TVL_PROJ_DPHI, STARK_3D, NEUMANN_3D, STEREOGRAPHIC and CARTESIAN. The light is
/// wi, the view wo; those with three coordinates are isotropic, but RUSIN_TH_PH_TD. #PARAM_OUT
/// INV_STERADIAN_COSINE_FACTOR is divided by cos theta_o. One value is grey, three are RGB. Throws Error on fewer
/// coordinates, other values, or coordinates that are no two directions of the upper hemisphere.
/// Checked against params.h and params.cpp of ALTA, whose to_cartesian is followed but for STEREOGRAPHIC, where it is
/// not the inverse of from_cartesian and the inverse is taken, and for RETRO_TL_TVL_PROJ_DPHI beyond the normal, where
/// the view's cosine of the azimuth keeps its sign; and against the retroreflective tape of its data. Source:
/// [Belcour 2014].
SampleFile parse_alta(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
