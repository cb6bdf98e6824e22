// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/image/drawing.h>
#include <burnish/image/markup.h>
#include <burnish/image/svg_plot.h>

namespace burnish {
namespace {

constexpr Color kPaper{255, 255, 255}, kInk{32, 34, 38}, kMuted{98, 102, 110}, kGrid{226, 228, 232};
// Distinct in hue and in lightness under the common colour deficiencies.
constexpr std::array<std::string_view, 8> kPalette = {"#1b6ca8", "#d1495b", "#2a9d6f", "#e08e0b",
                                                      "#7a4fb0", "#17a2b8", "#8c5a2b", "#4c4f56"};
constexpr double kTitleCap = 10.5, kLabelCap = 8.5, kTickCap = 8;
constexpr double kCurveWidth = 1.9, kDashOn = 7, kDashOff = 5;

struct Strokes {
  std::vector<std::vector<Point>> lines;
  double width = 1;
  Color color;
  bool dashed = false, clipped = false;
};

struct Text {
  Point at;
  std::string text;
  double cap_height = kTickCap;
  Color color = kInk;
  Align align = Align::left;
  bool upwards = false, bold = false;
};

struct Drawing {
  int width = 0, height = 0;
  Box frame;
  std::vector<Strokes> strokes;
  std::vector<Text> texts;
};

Color parse_color(const std::string& text) {
  unsigned value = 0;
  const char* const end = text.data() + text.size();
  if (text.size() != 7 || text[0] != '#' ||
      std::from_chars(text.data() + 1, end, value, 16) != std::from_chars_result{end, std::errc{}})
    throw Error(fmt::format("expected a colour \"#rrggbb\", found \"{}\"", text));
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
          static_cast<std::uint8_t>(value & 255)};
}

// The step 1, 2 or 5 times a power of ten next to span / count.
double round_step(double span, int count) {
  const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw))), lead = raw / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

// The values that a side of the frame spans.
struct PlotScale {
  double low = 0, high = 1;
  bool logarithmic = false;

  double scaled(double v) const { return logarithmic ? std::log10(v) : v; }
  bool shows(double v) const { return std::isfinite(v) && (!logarithmic || v > 0); }
  // 0 at the low end, 1 at the high one
  double place(double v) const { return (scaled(v) - scaled(low)) / (scaled(high) - scaled(low)); }
};

PlotScale make_scale(const Plot& plot, std::vector<double> PlotSeries::*member, bool logarithmic,
                     std::optional<double> fixed_low, std::optional<double> fixed_high, bool widen,
                     const char* name) {
  PlotScale axis{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                 logarithmic};
  for (const PlotSeries& series : plot.series)
    for (const double v : series.*member)
      if (axis.shows(v)) {
        axis.low = std::min(axis.low, v);
        axis.high = std::max(axis.high, v);
      }

  // nothing to show, or one value: still a span
  if (axis.low > axis.high) axis = {logarithmic ? 0.1 : 0.0, 1, logarithmic};
  if (axis.low == axis.high) {
    const double margin = axis.low != 0 ? std::abs(axis.low) / 2 : 0.5;
    axis.low -= margin;
    axis.high += margin;
  }

  // to whole ticks, or by a little
  if (widen && !logarithmic) {
    const double step = round_step(axis.high - axis.low, 6);
    axis.low = step * std::floor(axis.low / step + 1e-9);
    axis.high = step * std::ceil(axis.high / step - 1e-9);
  } else if (widen) {
    const double margin = std::max(0.02, 0.04 * std::log10(axis.high / axis.low));
    axis.low *= std::pow(10.0, -margin);
    axis.high *= std::pow(10.0, margin);
  }

  axis.low = fixed_low.value_or(axis.low);
  axis.high = fixed_high.value_or(axis.high);
  if (!(axis.low < axis.high) || !axis.shows(axis.low) || !axis.shows(axis.high))
    throw Error(fmt::format("expected increasing{} ends of the {} axis, found {:g} and {:g}",
                            logarithmic ? " positive" : "", name, axis.low, axis.high));
  return axis;
}

std::string tick_label(double v, double step) {
  if (std::abs(v) < 1e-9 * step) v = 0;
  std::string text = fmt::format("{:.6g}", v);
  if (const auto minus = text.find("e-0"); minus != text.npos) text.erase(minus + 2, 1);
  if (const auto plus = text.find("e+"); plus != text.npos)
    text.erase(plus + 1, text[plus + 2] == '0' ? 2 : 1);
  return text;
}

// The legend's rows under the title; returns the lowest y it uses.
double lay_out_legend(Drawing& drawing, const Plot& plot, const std::vector<Color>& colors, double left,
                      double right, double y) {
  constexpr double kSwatch = 24, kGap = 8, kBetween = 22, kRow = 18;
  double x = left;
  bool any = false;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    if (series.label.empty()) continue;
    const double length = kSwatch + kGap + text_width(series.label, kTickCap) * 1.12;
    if (any && x + length > right) {
      x = left;
      y += kRow;
    }
    any = true;
    const double middle = y - kTickCap / 2;
    if (series.style != PlotStyle::points)
      drawing.strokes.push_back({{{{x, middle}, {x + kSwatch, middle}}},
                                 kCurveWidth,
                                 colors[i],
                                 series.style == PlotStyle::dashed,
                                 false});
    if (series.style == PlotStyle::points || series.style == PlotStyle::line_and_points)
      drawing.strokes.push_back(
          {{{{x + kSwatch / 2, middle}}}, series.point_width + 1, colors[i], false, false});
    drawing.texts.push_back({{x + kSwatch + kGap, y}, series.label, kTickCap, kInk});
    x += length + kBetween;
  }
  return any ? y : y - kRow;
}

// One colour a series: its own, or the palette's next.
std::vector<Color> colors_of(const Plot& plot) {
  std::vector<Color> colors;
  std::size_t from_palette = 0;
  for (const PlotSeries& series : plot.series) {
    if (series.x.size() != series.y.size())
      throw Error(
          fmt::format("series \"{}\": {} x for {} y", series.label, series.x.size(), series.y.size()));
    colors.push_back(parse_color(
        series.color.empty() ? std::string(kPalette[from_palette++ % kPalette.size()]) : series.color));
  }
  return colors;
}

constexpr double kMargin = 16;

// The two scales, their ticks, and the frame they span in the drawing.
struct PlotArea {
  PlotScale x, y;
  std::vector<double> x_ticks, y_ticks;
  Box frame;

  double to_x(double v) const { return frame.x0 + (frame.x1 - frame.x0) * x.place(v); }
  double to_y(double v) const { return frame.y1 - (frame.y1 - frame.y0) * y.place(v); }
};

double step_of(const std::vector<double>& ticks) {
  return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
}

// Grid, tick labels, the axes themselves and their labels.
void lay_out_axes(Drawing& drawing, const Plot& plot, const PlotArea& area) {
  const auto [left, top, right, bottom] = area.frame;
  const auto crisp = [](double v) { return std::floor(v) + 0.5; };  // half-pixel places keep thin lines sharp
  Strokes grid{{}, 1, kGrid, false, false};
  for (const double v : area.x_ticks) {
    const double x = area.to_x(v);
    grid.lines.push_back({{crisp(x), top}, {crisp(x), bottom}});
    drawing.texts.push_back(
        {{x, bottom + kTickCap + 8}, tick_label(v, step_of(area.x_ticks)), kTickCap, kMuted, Align::center});
  }
  for (const double v : area.y_ticks) {
    const double y = area.to_y(v);
    grid.lines.push_back({{left, crisp(y)}, {right, crisp(y)}});
    drawing.texts.push_back(
        {{left - 8, y + kTickCap / 2}, tick_label(v, step_of(area.y_ticks)), kTickCap, kMuted, Align::right});
  }
  drawing.strokes.push_back(std::move(grid));
  drawing.strokes.push_back({{{{crisp(left), top}, {crisp(left), crisp(bottom)}, {right, crisp(bottom)}}},
                             1,
                             kMuted,
                             false,
                             false});
  if (!plot.x_label.empty())
    drawing.texts.push_back(
        {{(left + right) / 2, plot.height - kMargin + 1.0}, plot.x_label, kLabelCap, kInk, Align::center});
  if (!plot.y_label.empty())
    drawing.texts.push_back(
        {{kMargin + kLabelCap, (top + bottom) / 2}, plot.y_label, kLabelCap, kInk, Align::center, true});
}

// A line breaks where a value cannot be shown.
void lay_out_series(Drawing& drawing, const PlotSeries& series, Color color, const PlotArea& area) {
  Strokes curve{{}, kCurveWidth, color, series.style == PlotStyle::dashed, true};
  Strokes dots{{}, series.point_width, color, false, true};
  bool broken = true;
  for (std::size_t k = 0; k < series.x.size(); ++k) {
    if (!area.x.shows(series.x[k]) || !area.y.shows(series.y[k])) {
      broken = true;
      continue;
    }
    const Point p{area.to_x(series.x[k]), area.to_y(series.y[k])};
    if (broken) curve.lines.emplace_back();
    broken = false;
    curve.lines.back().push_back(p);
    dots.lines.push_back({p});
  }
  if (series.style != PlotStyle::points) drawing.strokes.push_back(std::move(curve));
  if (series.style == PlotStyle::points || series.style == PlotStyle::line_and_points)
    drawing.strokes.push_back(std::move(dots));
}

Drawing lay_out(const Plot& plot) {
  constexpr int kMinSize = 160, kMaxSize = 8192;
  if (std::min(plot.width, plot.height) < kMinSize || std::max(plot.width, plot.height) > kMaxSize)
    throw Error(fmt::format("expected a plot of {} to {} pixels, found {} x {}", kMinSize, kMaxSize,
                            plot.width, plot.height));
  const std::vector<Color> colors = colors_of(plot);

  // scales and ticks
  PlotArea area{make_scale(plot, &PlotSeries::x, plot.log_x, plot.x_min, plot.x_max, plot.log_x, "x"),
                make_scale(plot, &PlotSeries::y, plot.log_y, plot.y_min, plot.y_max, true, "y"),
                {},
                {},
                {}};
  area.x_ticks = axis_ticks(area.x.low, area.x.high, area.x.logarithmic, std::max(2, plot.width / 110));
  area.y_ticks = axis_ticks(area.y.low, area.y.high, area.y.logarithmic, std::max(2, plot.height / 65));
  double tick_width = 0;
  for (const double v : area.y_ticks)
    tick_width = std::max(tick_width, text_width(tick_label(v, step_of(area.y_ticks)), kTickCap));

  // the frame, inside of: y label and tick labels, title and legend, x label
  Drawing drawing{plot.width, plot.height, {}, {}, {}};
  const double left = kMargin + (plot.y_label.empty() ? 0 : 22) + tick_width + 10;
  const double right = plot.width - kMargin - 8;
  double top = kMargin + 4;
  if (!plot.title.empty()) {
    drawing.texts.push_back({{left, top + kTitleCap}, plot.title, kTitleCap, kInk, Align::left, false, true});
    top += kTitleCap + 14;
  }
  top = lay_out_legend(drawing, plot, colors, left, right, top + kTickCap) + 14;
  const double bottom = plot.height - kMargin - (plot.x_label.empty() ? 0 : 22) - kTickCap - 6;
  drawing.frame = area.frame = {left, top, right, bottom};

  // axes, then the series, the first one on top
  lay_out_axes(drawing, plot, area);
  for (std::size_t i = plot.series.size(); i-- > 0;) lay_out_series(drawing, plot.series[i], colors[i], area);
  return drawing;
}

std::string hex(Color color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b);
}

}  // namespace

std::vector<double> axis_ticks(double low, double high, bool logarithmic, int count) {
  std::vector<double> ticks;
  constexpr double kSlack = 1e-9;  // of a step: ends that are ticks up to rounding belong
  if (logarithmic) {
    const double decades = std::log10(high / low);
    const int step = std::max(1, static_cast<int>(std::ceil(decades / (1.5 * count))));
    const int first = static_cast<int>(std::floor(std::log10(low)));
    for (int power = first; power <= std::log10(high) + kSlack; ++power)
      for (const double lead : {1.0, 2.0, 5.0}) {
        if (lead > 1 ? decades >= 3 : power % step != 0) continue;
        const double v = lead * std::pow(10.0, power);
        if (v >= low * (1 - kSlack) && v <= high * (1 + kSlack)) ticks.push_back(v);
      }
    if (ticks.size() >= 2) return ticks;
    ticks.clear();  // less than an octave: mark it like a linear axis
  }
  const double step = round_step(high - low, count);
  for (double k = std::ceil(low / step - kSlack); k * step <= high + kSlack * step; ++k)
    ticks.push_back(k * step + 0.0);  // no negative zero
  return ticks;
}

std::string to_svg(const Plot& plot) {
  const Drawing drawing = lay_out(plot);
  constexpr double kCapOfFontSize = 0.72;  // height of capitals in common sans-serif fonts
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Inter, Helvetica, Arial, sans-serif\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"{2}\"/>\n"
      "<clipPath id=\"frame\"><rect x=\"{3:.2f}\" y=\"{4:.2f}\" width=\"{5:.2f}\" "
      "height=\"{6:.2f}\"/></clipPath>\n",
      drawing.width, drawing.height, hex(kPaper), drawing.frame.x0, drawing.frame.y0,
      drawing.frame.x1 - drawing.frame.x0, drawing.frame.y1 - drawing.frame.y0);
  for (const Strokes& strokes : drawing.strokes) {
    std::string path;
    for (const auto& line : strokes.lines) {
      for (std::size_t i = 0; i < line.size(); ++i)
        path += fmt::format("{}{:.2f} {:.2f}", i == 0 ? 'M' : 'L', line[i].x, line[i].y);
      if (line.size() == 1) path += "h0";  // a round cap of no length is a dot
    }
    svg += fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\"{}{}/>\n",
        path, hex(strokes.color), strokes.width,
        strokes.dashed ? fmt::format(" stroke-dasharray=\"{:g} {:g}\"", kDashOn, kDashOff) : "",
        strokes.clipped ? " clip-path=\"url(#frame)\"" : "");
  }
  for (const Text& text : drawing.texts) {
    const char* anchor = text.align == Align::left ? "start" : text.align == Align::center ? "middle" : "end";
    svg += fmt::format(
        "<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2:.4g}\" fill=\"{3}\" "
        "text-anchor=\"{4}\"{5}{6}>{7}</text>\n",
        text.at.x, text.at.y, text.cap_height / kCapOfFontSize, hex(text.color), anchor,
        text.bold ? " font-weight=\"600\"" : "",
        text.upwards ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", text.at.x, text.at.y) : "",
        escape_markup(text.text));
  }
  return svg + "</svg>\n";
}

Image8 to_image(const Plot& plot) {
  const Drawing drawing = lay_out(plot);
  Image8 image(drawing.width, drawing.height, 3);
  fill_rect(image, 0, 0, image.width, image.height, kPaper);
  for (const Strokes& strokes : drawing.strokes) {
    const Box clip = strokes.clipped ? drawing.frame : Box{};
    if (!strokes.dashed) {
      draw_strokes(image, strokes.lines, strokes.width, strokes.color, clip);
      continue;
    }
    std::vector<std::vector<Point>> pieces;
    for (const auto& line : strokes.lines)
      for (auto& dash : dashes(line, kDashOn, kDashOff)) pieces.push_back(std::move(dash));
    draw_strokes(image, pieces, strokes.width, strokes.color, clip);
  }
  for (const Text& text : drawing.texts)
    draw_text(image, text.at, text.text, text.cap_height, text.color, text.align, text.upwards);
  return image;
}

}  // namespace burnish
