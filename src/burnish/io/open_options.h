// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <burnish/reflectance/bsdf_part.h>

namespace burnish {

/// Options for opening a source.
struct OpenOptions {
  bool keep_spectral = false;    ///< one channel for each wavelength instead of linear Rec. 709
  std::string illuminant = "E";  ///< the light under which spectra become RGB: E, D50, D65, A or a file
  bool has_cosine = false;       ///< CSV and ASTM values are f_r cos(theta_i): divide it out
  bool clamp_negatives = true;   ///< set interpolated values below zero to zero
  bool back_side = false;        ///< prefer the back's reflection to the front's if a file has both sides
  bool has_cosine_o = false;     ///< CSV and ASTM values are f_r cos(theta_o): divide it out
  bool brf = false;              ///< CSV and ASTM values are reflectance factors, pi f_r: divide by pi
  std::optional<BsdfPart> part = {};  ///< empty: a reflection if there is one, the front's first
  std::string band = {};              ///< a band's name in any case; empty: the visible one first
  bool scale_to_tis = false;          ///< Zemax, LightTools: scale each incidence to its TIS
};

}  // namespace burnish
