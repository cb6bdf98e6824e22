// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burnish/image/image.h>

namespace burnish {

/// The drawing style of a series.
enum class PlotStyle { line, dashed, points, line_and_points };

/// One curve or cloud: y over x. Points that are not finite, or not positive on a logarithmic axis, are left
/// out, and a line is interrupted there.
struct PlotSeries {
  std::string label;  ///< in the legend; none if empty
  std::vector<double> x, y;
  PlotStyle style = PlotStyle::line;
  std::string color = {};    ///< "#rrggbb"; empty takes the next colour of a colour-blind safe palette
  double point_width = 4.5;  ///< pixels, of points
};

/// A picture of some series over common axes. Labels are UTF-8.
struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<PlotSeries> series;
  /// Ends of the axes; where unset, the data's, widened to round numbers.
  std::optional<double> x_min = {}, x_max = {}, y_min = {}, y_max = {};
  int width = 720, height = 440;  ///< pixels
};

/// The plot as an SVG document. Throws Error where a series' x and y differ in length, a colour is not
/// "#rrggbb", the ends of an axis do not increase or are not positive on a logarithmic axis, or the size is
/// outside [160, 8192].
std::string to_svg(const Plot& plot);

/// The same drawing as pixels, RGB. Throws as to_svg.
Image8 to_image(const Plot& plot);

/// Round numbers from within [low, high] that mark an axis, about `count` of them: steps of 1, 2 or 5 times a
/// power of ten; on a logarithmic axis decades, and also 2 and 5 within them where there are fewer than three
/// decades. low < high, and > 0 if logarithmic.
std::vector<double> axis_ticks(double low, double high, bool logarithmic, int count = 6);

}  // namespace burnish
