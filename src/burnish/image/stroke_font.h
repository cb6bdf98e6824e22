// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <burnish/image/drawing.h>

namespace burnish {

/// One laid-out text: polylines in units of 1/8 of the capitals' height, y downwards, the baseline at y = 0
/// and the text's left end at x = 0; a polyline of one point is a dot.
struct TextStrokes {
  std::vector<std::vector<Point>> strokes;
  double width = 0;
};

/// Lays out UTF-8 text in the built-in font.
TextStrokes text_strokes(std::string_view text);

}  // namespace burnish
