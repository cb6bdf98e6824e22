// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace burnish {

/// Weight of a squared error in x >= 0 that makes it about the squared error of what a picture shows of x:
/// 1 / ((x + m/100) (1 + 10 x / m)), m > 0 the mean of x. Up to m/10 errors count as errors of the root,
/// above as relative errors; the first term keeps black from ruling. The idea is that of [Bagher 2016]; the
/// two shares of the mean are those with the best pictures of eight measured materials.
inline double compressive_weight(double x, double mean) noexcept {
  return 1 / ((x + 0.01 * mean) * (1 + 10 * x / mean));
}

}  // namespace burnish
