// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/angle_table.h>

namespace burnish::fixtures {

/// Draws a uniform number of mean 0 and variance 1.
inline double draw_even(Pcg32& random) {
  return std::sqrt(12) * (random.uniform() - 0.5);
}

/// Returns a virtual measurement: GGX with noise of 30 % in proportion. The value that a third of the values lies
/// below is then subtracted from all.
inline AngleTable noisy_table() {
  AngleTable layout;
  layout.folded = true;
  layout.axes = {make_axis({0}, kTwoPi), make_axis(cell_centres(30, kHalfPi)),
                 make_axis(cell_centres(30, kHalfPi)), make_axis(cell_centres(36, kPi))};
  AngleTable table = tabulate_angles(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2"), layout);
  Pcg32 random(7);
  std::vector<float> values;
  for (float& value : table.values) {
    if (std::isnan(value)) continue;
    value *= static_cast<float>(1 + 0.3 * draw_even(random));
    values.push_back(value);
  }
  const auto third = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 3);
  std::ranges::nth_element(values, third);
  for (float& value : table.values) value -= *third;
  return table;
}

}  // namespace burnish::fixtures
