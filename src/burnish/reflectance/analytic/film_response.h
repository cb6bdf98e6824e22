// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace burnish {

/// The response of X, Y and Z to light that interferes in a thin film: Gaussians over the wavenumber. Their Fourier
/// transforms are value sqrt(2 pi variance) / kFilmNorm cos(position phase + shift) exp(-variance phase^2), where
/// phase is 2 pi times the path difference in metres. The constants are those of the paper's code. Source: [Belcour
/// 2017, section 4].
struct FilmResponse {
  std::size_t channel;  ///< 0, 1 and 2 of X, Y and Z
  double value, position, variance;
};
inline constexpr std::array<FilmResponse, 4> kFilmResponses = {{{0, 5.4856e-13, 1.6810e6, 4.3278e9},
                                                                {0, 9.7470e-14, 2.2399e6, 4.5282e9},
                                                                {1, 4.4201e-13, 1.7953e6, 9.3046e9},
                                                                {2, 5.2481e-13, 2.2084e6, 6.6121e9}}};
inline constexpr double kFilmNorm = 1.0685e-7;

}  // namespace burnish
