// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// Colour matching functions x, y, z of the CIE 1931 2 degree observer at a wavelength; zero outside
/// [380, 780] nm. Linear between tabulated values every 5 nm: within 0.017 of the table of 1 nm steps.
/// Source: [CIE 2018].
std::array<double, 3> cie_1931_xyz(double lambda_nm) noexcept;

/// Relative power of the CIE illuminant D65, 100 at 560 nm; zero outside [380, 780] nm, linear between the
/// tabulated values. Source: [CIE 2018].
double cie_d65(double lambda_nm) noexcept;

/// A light by its relative power: linear between wavelengths in nm, zero beyond them.
struct Illuminant {
  std::string name;
  std::vector<double> lambda_nm, power;

  double at(double lambda) const noexcept;
};

/// "E" (equal energy), "D50", "D65" or "A" of the CIE over [380, 780] nm; D50 from the components of daylight in steps
/// of 10 nm, A from its formula in steps of 5 nm. Throws Error for another name. Source: [CIE 2018].
Illuminant standard_illuminant(std::string_view name);

/// Weights that turn a reflectance spectrum sampled at `lambda_nm` into linear Rec. 709, rgb = sum_k w_k f_k,
/// under an illuminant.
/// Domain: increasing, positive wavelengths, at least one; steps may vary. The spectrum is taken as linear
/// between samples and constant beyond the first and the last, which defines the part of the visible range
/// that is not covered.
/// The illuminant's own white is adapted to that of Rec. 709 (Bradford), so the weights sum to (1, 1, 1)
/// within 1e-12 and a flat spectrum f = 1 is white under either illuminant. Weights of single wavelengths may
/// be negative: saturated colours lie outside the gamut. Throws Error for an illuminant that is dark in the visible
/// range or a list outside the domain. Source: [CIE 2018], [ITU 2015], [Lam 1985].
std::vector<std::array<double, 3>> rec709_weights(std::span<const double> lambda_nm,
                                                  const Illuminant& illuminant);
/// Under standard_illuminant(name).
std::vector<std::array<double, 3>> rec709_weights(std::span<const double> lambda_nm, std::string_view name);

/// Linear Rec. 709 of a reflectance's or transmittance's X, Y, Z under equal energy, where white has X = Y = Z = 1: the
/// white is adapted as in rec709_weights and becomes (1, 1, 1). Saturated colours have values below zero.
std::array<double, 3> rec709_of_equal_energy(const std::array<double, 3>& xyz) noexcept;

/// The nodes of a spectrum that shows a colour: linear Rec. 709's blue up to the first, green between the second and
/// the third, red from the last on. At these places no colour takes a value below zero.
inline constexpr std::array<double, 4> kColourNodes_nm{475, 510, 580, 605};
/// A spectrum at kColourNodes_nm whose colour under equal energy is `rgb` within 1e-14 of the largest channel, not
/// negative where none of the channels is; (1, 1, 1) is flat.
std::array<double, 4> spectrum_of_colour(std::span<const double, 3> rgb);

}  // namespace burnish
