// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <burnish/lighting/area_light_table.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

struct AreaLightFitOptions {
  std::size_t lobes = 3;    ///< besides the cosine, in [1, AreaLightTable::kMaxLobes]
  std::size_t thetas = 32;  ///< nodes over theta_o of an isotropic BRDF, in [4, 256]
  std::size_t polars = 12;  ///< nodes over theta_o of an anisotropic one, in [4, 256]
  std::size_t quarter = 7;  ///< nodes over a quarter of its azimuths, in [2, 64]
  int iterations = 40;      ///< steps of every minimization, >= 1
  bool with_cosine = true;  ///< false: the plain cosine has height zero
  std::function<void(double fraction)> progress = {};  ///< called with rising shares of the work
};

/// Fits a table to any BRDF. The trial lamps are squares of 3, 10, 30 and 90 degrees, equally likely everywhere. For
/// every view, Levenberg-Marquardt minimizes the squared differences of their tone-mapped reflections. Each node
/// starts from its neighbour and is held near it, so that lobes change smoothly. Heights are positive. They are
/// scaled at the end so that at nodes the table's albedo is that of the BRDF, computed with 96 x 192 half vectors.
///
/// Linearly transformed cosines cannot show rings of colour about a highlight, nor highlights whose light falls
/// faster than the fourth power of the angle. The fit is deterministic. Throws Error for options out of range and for
/// other than 1 or 3 channels.
AreaLightTable fit_area_lights(BrdfRef brdf, const AreaLightFitOptions& options = {});

}  // namespace burnish
