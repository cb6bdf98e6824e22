#pragma once

#include <string>

#include <burnish/math/spectrum.h>

namespace burnish {

/// A standard_illuminant by its name, or a text file of rows: wavelength in nm, increasing, and relative power, at
/// least two. Throws Error for neither, or a power that is not finite or below zero.
Illuminant open_illuminant(const std::string& spec);

/// What findings call it: "equal energy" for "E".
std::string illuminant_name(const std::string& spec);

}  // namespace burnish
