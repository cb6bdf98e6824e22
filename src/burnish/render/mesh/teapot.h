// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

#include <burnish/math/vec3.h>

namespace burnish {

/// A bicubic Bezier patch: control point i along u and j along v is [4 * j + i].
using BezierPatch = std::array<Vec3, 16>;

/// One quarter or half of each part of the teapot; the rest are its mirror images.
/// Rim, body, lid and bottom are turned about z and made of four, handle and spout of two.
// clang-format off
inline constexpr std::array<BezierPatch, 10> kTeapotParts{{
    // rim
    {{{1.4, 0, 2.4}, {1.4, -0.784, 2.4}, {0.784, -1.4, 2.4}, {0, -1.4, 2.4},
      {1.3375, 0, 2.53125}, {1.3375, -0.749, 2.53125}, {0.749, -1.3375, 2.53125}, {0, -1.3375, 2.53125},
      {1.4375, 0, 2.53125}, {1.4375, -0.805, 2.53125}, {0.805, -1.4375, 2.53125}, {0, -1.4375, 2.53125},
      {1.5, 0, 2.4}, {1.5, -0.84, 2.4}, {0.84, -1.5, 2.4}, {0, -1.5, 2.4}}},
    // body
    {{{1.5, 0, 2.4}, {1.5, -0.84, 2.4}, {0.84, -1.5, 2.4}, {0, -1.5, 2.4},
      {1.75, 0, 1.875}, {1.75, -0.98, 1.875}, {0.98, -1.75, 1.875}, {0, -1.75, 1.875},
      {2, 0, 1.35}, {2, -1.12, 1.35}, {1.12, -2, 1.35}, {0, -2, 1.35},
      {2, 0, 0.9}, {2, -1.12, 0.9}, {1.12, -2, 0.9}, {0, -2, 0.9}}},
    // body
    {{{2, 0, 0.9}, {2, -1.12, 0.9}, {1.12, -2, 0.9}, {0, -2, 0.9},
      {2, 0, 0.45}, {2, -1.12, 0.45}, {1.12, -2, 0.45}, {0, -2, 0.45},
      {1.5, 0, 0.225}, {1.5, -0.84, 0.225}, {0.84, -1.5, 0.225}, {0, -1.5, 0.225},
      {1.5, 0, 0.15}, {1.5, -0.84, 0.15}, {0.84, -1.5, 0.15}, {0, -1.5, 0.15}}},
    // handle
    {{{-1.6, 0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0, 2.25},
      {-2.3, 0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0, 2.25},
      {-2.7, 0, 2.025}, {-2.7, -0.3, 2.025}, {-3, -0.3, 2.25}, {-3, 0, 2.25},
      {-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}}},
    // handle
    {{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8},
      {-2.7, 0, 1.575}, {-2.7, -0.3, 1.575}, {-3, -0.3, 1.35}, {-3, 0, 1.35},
      {-2.5, 0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0, 0.9375},
      {-2, 0, 0.9}, {-2, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0, 0.6}}},
    // spout
    {{{1.7, 0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0, 0.6},
      {2.6, 0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0, 0.825},
      {2.3, 0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0, 2.025},
      {2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}},
    // spout
    {{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4},
      {2.8, 0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0, 2.49375},
      {2.9, 0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0, 2.5125},
      {2.8, 0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0, 2.4}}},
    // lid
    {{{0, 0, 3.15}, {0, 0, 3.15}, {0, 0, 3.15}, {0, 0, 3.15},
      {0.8, 0, 3.15}, {0.8, -0.45, 3.15}, {0.45, -0.8, 3.15}, {0, -0.8, 3.15},
      {0, 0, 2.85}, {0, 0, 2.85}, {0, 0, 2.85}, {0, 0, 2.85},
      {0.2, 0, 2.7}, {0.2, -0.112, 2.7}, {0.112, -0.2, 2.7}, {0, -0.2, 2.7}}},
    // lid
    {{{0.2, 0, 2.7}, {0.2, -0.112, 2.7}, {0.112, -0.2, 2.7}, {0, -0.2, 2.7},
      {0.4, 0, 2.55}, {0.4, -0.224, 2.55}, {0.224, -0.4, 2.55}, {0, -0.4, 2.55},
      {1.3, 0, 2.55}, {1.3, -0.728, 2.55}, {0.728, -1.3, 2.55}, {0, -1.3, 2.55},
      {1.3, 0, 2.4}, {1.3, -0.728, 2.4}, {0.728, -1.3, 2.4}, {0, -1.3, 2.4}}},
    // bottom
    {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
      {1.425, 0, 0}, {1.425, 0.798, 0}, {0.798, 1.425, 0}, {0, 1.425, 0},
      {1.5, 0, 0.075}, {1.5, 0.84, 0.075}, {0.84, 1.5, 0.075}, {0, 1.5, 0.075},
      {1.5, 0, 0.15}, {1.5, 0.84, 0.15}, {0.84, 1.5, 0.15}, {0, 1.5, 0.15}}},
}};
// clang-format on
inline constexpr std::array<bool, 10> kTeapotPartIsTurned{true,  true,  true, false, false,
                                                          false, false, true, true,  true};

/// The Utah teapot: 32 patches, z up, from its bottom at z = 0 to the knob at 3.15, the spout towards +x. The
/// surface's derivatives along u and v span its outward normal by their cross product; one row of control
/// points falls together at the knob's top and the bottom's middle. Source: the measurements of
/// [Newell 1975] in the proportions of [Crow 1987], with its bottom.
constexpr std::array<BezierPatch, 32> teapot_patches() noexcept {
  std::array<BezierPatch, 32> patches{};
  std::size_t count = 0;
  for (std::size_t part = 0; part < kTeapotParts.size(); ++part)
    for (int image = 0; image < (kTeapotPartIsTurned[part] ? 4 : 2); ++image) {
      BezierPatch& patch = patches[count++] = kTeapotParts[part];
      for (Vec3& p : patch) p = {image >= 2 ? -p.x : p.x, image % 2 == 1 ? -p.y : p.y, p.z};
      if (image != 1 && image != 2) continue;
      // one reflection turns the surface inside out: run along u the other way
      for (std::size_t row = 0; row < 16; row += 4) {
        std::swap(patch[row], patch[row + 3]);
        std::swap(patch[row + 1], patch[row + 2]);
      }
    }
  return patches;
}

}  // namespace burnish
