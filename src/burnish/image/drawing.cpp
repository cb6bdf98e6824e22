// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/image/drawing.h>
#include <burnish/image/stroke_font.h>

namespace burnish {
namespace {

constexpr double kFontUnits = 8;  // of the stroke font, in the height of a capital

void blend(std::span<std::uint8_t> pixel, Color color, double coverage) noexcept {
  const double a = coverage * color.alpha;
  const auto mix = [a](std::uint8_t under, double over) {
    return static_cast<std::uint8_t>(std::lround(under + a * (over - under)));
  };
  pixel[0] = mix(pixel[0], color.r);
  pixel[1] = mix(pixel[1], color.g);
  pixel[2] = mix(pixel[2], color.b);
  if (pixel.size() == 4) pixel[3] = mix(pixel[3], 255);
}

double distance_to_segment(Point p, Point a, Point b) noexcept {
  const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
  const double along =
      squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

/// Coverage of a set of strokes, the largest of any at each pixel, so that joints and crossings do not
/// darken.
class Mask {
 public:
  Mask(const Image8& image, const Box& clip)
      : x0_(std::clamp(static_cast<int>(std::floor(clip.x0)), 0, image.width)),
        y0_(std::clamp(static_cast<int>(std::floor(clip.y0)), 0, image.height)),
        x1_(clip.x1 < image.width ? std::max(x0_, static_cast<int>(std::ceil(clip.x1))) : image.width),
        y1_(clip.y1 < image.height ? std::max(y0_, static_cast<int>(std::ceil(clip.y1))) : image.height),
        coverage_(static_cast<std::size_t>(x1_ - x0_) * static_cast<std::size_t>(y1_ - y0_)) {}

  void add(std::span<const Point> points, double width) noexcept {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) add_segment(points[i], points[i + 1], width / 2);
    if (points.size() == 1) add_segment(points[0], points[0], width / 2);
  }

  void paint(Image8& image, Color color) const noexcept {
    for (int y = y0_; y < y1_; ++y)
      for (int x = x0_; x < x1_; ++x)
        if (const float c = coverage_[index(x, y)]; c > 0) blend(image.at(x, y), color, c);
  }

 private:
  std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(x1_ - x0_) +
           static_cast<std::size_t>(x - x0_);
  }
  // A pixel is covered by how far its centre lies inside the stroke's edge, up to half a pixel on each side.
  void add_segment(Point a, Point b, double radius) noexcept {
    const auto within = [](double v, int low, int high) {
      return static_cast<int>(std::clamp(v, static_cast<double>(low), static_cast<double>(high)));
    };
    const double reach = radius + 1;
    const int left = within(std::min(a.x, b.x) - reach, x0_, x1_);
    const int right = within(std::max(a.x, b.x) + reach, x0_, x1_);
    const int top = within(std::min(a.y, b.y) - reach, y0_, y1_);
    const int bottom = within(std::max(a.y, b.y) + reach, y0_, y1_);
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const double distance = distance_to_segment({x + 0.5, y + 0.5}, a, b);
        float& c = coverage_[index(x, y)];
        c = std::max(c, static_cast<float>(std::clamp(radius + 0.5 - distance, 0.0, 1.0)));
      }
  }

  int x0_, y0_, x1_, y1_;
  std::vector<float> coverage_;
};

}  // namespace

void fill_rect(Image8& image, int x0, int y0, int x1, int y1, Color color) noexcept {
  for (int y = std::max(0, y0); y < std::min(y1, image.height); ++y)
    for (int x = std::max(0, x0); x < std::min(x1, image.width); ++x) blend(image.at(x, y), color, 1);
}

void blit(Image8& to, const Image8& from, int x, int y) noexcept {
  for (int row = std::max(0, -y); row < std::min(from.height, to.height - y); ++row)
    for (int column = std::max(0, -x); column < std::min(from.width, to.width - x); ++column) {
      const auto pixel = from.at(column, row);
      blend(to.at(x + column, y + row), {pixel[0], pixel[1], pixel[2]},
            from.channels == 4 ? pixel[3] / 255.0 : 1.0);
    }
}

void draw_strokes(Image8& image, std::span<const std::vector<Point>> strokes, double width, Color color,
                  const Box& clip) {
  Mask mask(image, clip);
  for (const auto& stroke : strokes) mask.add(stroke, width);
  mask.paint(image, color);
}

std::vector<std::vector<Point>> dashes(std::span<const Point> points, double on, double off) {
  std::vector<std::vector<Point>> result;
  bool drawing = false;
  double left = 0;  // of the current dash or gap
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point a = points[i], b = points[i + 1];
    const double total = std::hypot(b.x - a.x, b.y - a.y);
    for (double done = 0; done < total;) {
      // a dash or gap is used up: the other begins
      const Point here{a.x + (b.x - a.x) * done / total, a.y + (b.y - a.y) * done / total};
      if (left <= 0) {
        drawing = !drawing;
        left = drawing ? on : off;
        if (drawing) result.push_back({here});
      }
      const double step = std::min(left, total - done);
      done += step;
      left -= step;
      if (drawing)
        result.back().push_back({a.x + (b.x - a.x) * done / total, a.y + (b.y - a.y) * done / total});
    }
  }
  return result;
}

void draw_text(Image8& image, Point at, std::string_view text, double cap_height, Color color, Align align,
               bool upwards) {
  TextStrokes laid_out = text_strokes(text);
  const double unit = cap_height / kFontUnits;
  const double start = align == Align::left     ? 0
                       : align == Align::center ? -laid_out.width * unit / 2
                                                : -laid_out.width * unit;
  // stems that meet pixel centres stay crisp
  const auto snap = [](double v) { return std::floor(v) + 0.5; };
  const Point origin =
      upwards ? Point{snap(at.x), snap(at.y - start)} : Point{snap(at.x + start), snap(at.y)};

  // room for the text and a little around it
  const double width = std::max(1.1, 0.13 * cap_height);
  const double far = laid_out.width * unit + cap_height, high = 2 * cap_height;
  Mask mask(image, upwards ? Box{origin.x - high, origin.y - far, origin.x + high, origin.y + cap_height}
                           : Box{origin.x - cap_height, origin.y - high, origin.x + far, origin.y + high});
  for (auto& stroke : laid_out.strokes) {
    // from the font's units, turned where the text runs upwards
    for (Point& p : stroke) {
      p = {p.x * unit, p.y * unit};
      p = upwards ? Point{origin.x + p.y, origin.y - p.x} : Point{origin.x + p.x, origin.y + p.y};
    }
    mask.add(stroke, stroke.size() == 1 ? 1.4 * width : width);
  }
  mask.paint(image, color);
}

double text_width(std::string_view text, double cap_height) {
  return text_strokes(text).width * cap_height / kFontUnits;
}

}  // namespace burnish
