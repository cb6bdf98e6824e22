// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burnish/image/drawing.h>
#include <burnish/image/image.h>

namespace burnish {

/// Colour of t in [0, 1] (clamped) on a scale from near black over purple, red and orange to pale yellow
/// whose lightness rises evenly. Interpolated between anchors in Oklab [Ottosson 2020].
Color heat_color(double t) noexcept;

/// Mean over the channels of |a - b|, one channel; one channel stands for every channel of the other. Throws
/// Error if sizes or channels do not fit.
Image mean_difference(const Image& a, const Image& b);

/// One channel of values, 0 to `scale`, as heat_color; values beyond get the end's colour. Throws Error if
/// there are more channels or scale is not above 0.
Image8 heat_map(const Image& values, double scale);

/// The scale of a heat map's colours: 0 to `scale`.
struct ColorBar {
  double scale = 1;
  std::string label;
};

/// Pictures in rows and columns with headings, on a dark ground.
struct ContactSheet {
  std::string title;
  std::vector<std::string> column_labels;  ///< a line break splits a heading into lines
  std::vector<std::string> row_labels;
  std::vector<std::vector<Image8>> cells;  ///< cells[row][column], of any sizes; an empty image leaves a gap
  std::optional<ColorBar> color_bar = {};
};

/// The sheet as one RGB picture. Throws Error if the rows and columns do not fit their labels.
Image8 compose(const ContactSheet& sheet);

}  // namespace burnish
