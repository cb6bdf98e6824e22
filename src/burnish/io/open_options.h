#pragma once

#include <string>

namespace burnish {

/// How a source is opened.
struct OpenOptions {
  bool keep_spectral = false;    ///< one channel a wavelength instead of linear Rec. 709
  std::string illuminant = "E";  ///< the light under which spectra become RGB: E, D50, D65, A or a file
  bool has_cosine = false;       ///< CSV and ASTM values are f_r cos(theta_i): divide it out
  bool clamp_negatives = true;   ///< set interpolated values below zero to zero
  bool back_side = false;        ///< Klems: "Reflection Back" instead of "Reflection Front"
  bool has_cosine_o = false;     ///< CSV and ASTM values are f_r cos(theta_o): divide it out
  bool brf = false;              ///< CSV and ASTM values are reflectance factors, pi f_r: divide by pi
};

}  // namespace burnish
