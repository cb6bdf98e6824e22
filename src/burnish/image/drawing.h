// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <burnish/image/image.h>

namespace burnish {

/// An sRGB colour with its opacity in [0, 1].
struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
  double alpha = 1;

  friend constexpr bool operator==(const Color&, const Color&) = default;
};

/// A place in an image, in pixels: x to the right, y downwards; the centre of the first pixel is (0.5, 0.5).
struct Point {
  double x = 0, y = 0;

  friend constexpr bool operator==(const Point&, const Point&) = default;
};

/// The part of the plane that drawing may touch.
struct Box {
  double x0 = 0, y0 = 0;
  double x1 = std::numeric_limits<double>::infinity(), y1 = std::numeric_limits<double>::infinity();
};

/// Which point of a text its position names: the left end, the middle or the right end of its baseline.
enum class Align { left, center, right };

/// Fills the pixels [x0, x1) x [y0, y1) that lie within the image.
void fill_rect(Image8& image, int x0, int y0, int x1, int y1, Color color) noexcept;

/// Copies `from` onto `to` with its top left corner at (x, y), over what is there where it has alpha; what
/// hangs over the edge is cut off.
void blit(Image8& to, const Image8& from, int x, int y) noexcept;

/// Draws polylines with round ends and joints, `width` >= 1 pixels wide, antialiased and as one: where they
/// cross, a translucent colour is not darker. A polyline of one point is a disc. Alpha of the image, if any,
/// rises with the coverage.
void draw_strokes(Image8& image, std::span<const std::vector<Point>> strokes, double width, Color color,
                  const Box& clip = {});

/// Cuts connected segments into dashes of `on` pixels with gaps of `off` pixels; both > 0.
std::vector<std::vector<Point>> dashes(std::span<const Point> points, double on, double off);

/// Draws UTF-8 text in the built-in stroke font; capitals are `cap_height` pixels high. Knows ASCII, the
/// Greek letters and signs that labels here need; anything else is drawn as a box. `upwards` turns the
/// baseline to run from bottom to top.
void draw_text(Image8& image, Point at, std::string_view text, double cap_height, Color color,
               Align align = Align::left, bool upwards = false);

/// Length of the text's baseline in pixels.
double text_width(std::string_view text, double cap_height);

}  // namespace burnish
