// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/render/light/environment_light.h>

namespace burnish {

/// Two coloured lamps in a sky that varies around the horizon.
inline const Environment kLamps{
    "lamps",
    {0.3, 0.5, 1},
    {1, 1, 1},
    {0.2, 0.1, 0.1},
    {{normalize({0.4, 0.5, 0.7}), 0.4, 6}, {normalize({-0.8, -0.3, 0.5}), 0.2, 10}}};
/// The same light from every direction.
inline const Environment kEven{"even", 2, 2, 2, {}};

}  // namespace burnish
