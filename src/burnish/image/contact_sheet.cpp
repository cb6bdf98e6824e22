// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/svg_plot.h>
#include <burnish/math/srgb.h>

namespace burnish {
namespace {

constexpr Color kGround{24, 26, 30}, kCell{14, 15, 18}, kInk{228, 230, 234}, kMuted{158, 163, 172};
constexpr double kTitleCap = 12, kHeadCap = 9, kLabelCap = 8;
constexpr int kMargin = 28, kGap = 10, kLine = 17;

struct Oklab {
  double lightness, a, b;
};

Color to_srgb(Oklab color) noexcept {
  // [Ottosson 2020]: to cone responses, to linear Rec. 709
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(color.lightness + 0.3963377774 * color.a + 0.2158037573 * color.b);
  const double m = cube(color.lightness - 0.1055613458 * color.a - 0.0638541728 * color.b);
  const double s = cube(color.lightness - 0.0894841775 * color.a - 1.2914855480 * color.b);
  const auto byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(std::clamp(v, 0.0, 1.0))));
  };
  return {byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  return lines;
}

void draw_color_bar(Image8& image, const ColorBar& bar, int x, int y0, int y1) {
  constexpr int kWidth = 14;
  for (int y = y0; y < y1; ++y)
    fill_rect(image, x, y, x + kWidth, y + 1, heat_color((y1 - y - 0.5) / (y1 - y0)));
  for (const double tick : axis_ticks(0, bar.scale, false, 5)) {
    const double y = y1 - (y1 - y0) * tick / bar.scale;
    const int row = std::clamp(static_cast<int>(y), y0, y1 - 1);
    fill_rect(image, x + kWidth, row, x + kWidth + 4, row + 1, kMuted);
    draw_text(image, {x + kWidth + 9.0, y + kLabelCap / 2}, fmt::format("{:.4g}", tick), kLabelCap, kInk);
  }
  draw_text(image, {x + kWidth + 58.0, (y0 + y1) / 2.0}, bar.label, kLabelCap, kMuted, Align::center, true);
}

}  // namespace

Color heat_color(double t) noexcept {
  // lightness in equal steps; the hue turns from violet (0.8 of a turn) through red to yellow
  constexpr std::array<Oklab, 8> kAnchors = {{{0.10, 0.005, -0.02},
                                              {0.225, 0.055, -0.11},
                                              {0.35, 0.13, -0.10},
                                              {0.475, 0.18, -0.02},
                                              {0.60, 0.175, 0.075},
                                              {0.725, 0.105, 0.135},
                                              {0.85, 0.02, 0.165},
                                              {0.975, -0.02, 0.075}}};
  const double place = (t > 0 ? std::min(t, 1.0) : 0) * (kAnchors.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kAnchors.size() - 2);
  const double s = place - static_cast<double>(i);
  const Oklab &low = kAnchors[i], &high = kAnchors[i + 1];
  return to_srgb({low.lightness + s * (high.lightness - low.lightness), low.a + s * (high.a - low.a),
                  low.b + s * (high.b - low.b)});
}

Image mean_difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height ||
      (a.channels != b.channels && a.channels != 1 && b.channels != 1))
    throw Error("a difference needs two images of one size and as many channels");
  const auto channels = static_cast<std::size_t>(std::max(a.channels, b.channels));
  Image difference(a.width, a.height, 1);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      float sum = 0;
      for (std::size_t c = 0; c < channels; ++c)
        sum += std::abs(a.at(x, y)[a.channels == 1 ? 0 : c] - b.at(x, y)[b.channels == 1 ? 0 : c]);
      difference.at(x, y)[0] = sum / static_cast<float>(channels);
    }
  return difference;
}

Image8 heat_map(const Image& values, double scale) {
  if (values.channels != 1) throw Error("a heat map shows one channel");
  if (!(scale > 0)) throw Error(fmt::format("expected the scale of a heat map above 0, found {}", scale));
  Image8 map(values.width, values.height, 3);
  for (int y = 0; y < values.height; ++y)
    for (int x = 0; x < values.width; ++x) {
      const Color color = heat_color(values.at(x, y)[0] / scale);
      std::ranges::copy(std::array{color.r, color.g, color.b}, map.at(x, y).begin());
    }
  return map;
}

namespace {

// The positions of a sheet's parts, in pixels: the title, the headings, then the rows.
struct SheetLayout {
  std::vector<int> widths, heights;  // of columns and rows
  double row_label_width = 0;
  int left = 0, heads = 0, top = 0, bar_x = 0, bottom = 0;
  int width = 0, height = 0;
};

SheetLayout lay_out(const ContactSheet& sheet) {
  // columns hold their headings and cells, rows their cells
  const std::size_t columns = sheet.column_labels.size(), rows = sheet.row_labels.size();
  if (sheet.cells.size() != rows)
    throw Error(fmt::format("a sheet of {} row labels with {} rows", rows, sheet.cells.size()));
  SheetLayout at{.widths = std::vector<int>(columns), .heights = std::vector<int>(rows)};
  std::size_t head_lines = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    const auto lines = lines_of(sheet.column_labels[c]);
    head_lines = std::max(head_lines, lines.size());
    for (const auto& line : lines)
      at.widths[c] = std::max(at.widths[c], static_cast<int>(std::ceil(text_width(line, kHeadCap))) + 2);
  }
  for (std::size_t r = 0; r < rows; ++r) {
    if (sheet.cells[r].size() != columns)
      throw Error(fmt::format("a sheet of {} column labels with {} columns", columns, sheet.cells[r].size()));
    at.row_label_width = std::max(at.row_label_width, text_width(sheet.row_labels[r], kHeadCap));
    for (std::size_t c = 0; c < columns; ++c) {
      at.widths[c] = std::max(at.widths[c], sheet.cells[r][c].width);
      at.heights[r] = std::max(at.heights[r], sheet.cells[r][c].height);
    }
  }

  // one after another, with gaps
  at.left = kMargin + (at.row_label_width > 0 ? static_cast<int>(at.row_label_width) + 16 : 0);
  at.heads = kMargin + (sheet.title.empty() ? 0 : static_cast<int>(kTitleCap) + 22);
  at.top = at.heads + kLine * static_cast<int>(head_lines);
  at.width = at.left;
  at.bottom = at.top - kGap;
  for (const int w : at.widths) at.width += w + kGap;
  for (const int h : at.heights) at.bottom += h + kGap;
  at.bar_x = at.width + 8;
  at.width += kMargin - kGap + (sheet.color_bar ? 90 : 0);
  at.width = std::max(at.width, static_cast<int>(text_width(sheet.title, kTitleCap)) + 2 * kMargin);
  at.height = at.bottom + kMargin;
  return at;
}

}  // namespace

Image8 compose(const ContactSheet& sheet) {
  const SheetLayout at = lay_out(sheet);
  Image8 image(at.width, at.height, 3);
  fill_rect(image, 0, 0, image.width, image.height, kGround);

  // title and headings
  if (!sheet.title.empty())
    draw_text(image, {static_cast<double>(kMargin), kMargin + kTitleCap - 2}, sheet.title, kTitleCap, kInk);
  int head_x = at.left;
  for (std::size_t c = 0; c < at.widths.size(); ++c) {
    const auto lines = lines_of(sheet.column_labels[c]);
    for (std::size_t i = 0; i < lines.size(); ++i)
      draw_text(image,
                {static_cast<double>(head_x) + 1,
                 at.heads + kHeadCap + static_cast<double>(kLine * static_cast<int>(i)) - 4},
                lines[i], kHeadCap, i == 0 ? kInk : kMuted);
    head_x += at.widths[c] + kGap;
  }

  // rows of cells
  int y = at.top;
  for (std::size_t r = 0; r < at.heights.size(); ++r) {
    draw_text(image, {kMargin + at.row_label_width, y + at.heights[r] / 2.0 + kHeadCap / 2},
              sheet.row_labels[r], kHeadCap, kMuted, Align::right);
    int x = at.left;
    for (std::size_t c = 0; c < at.widths.size(); ++c) {
      const Image8& cell = sheet.cells[r][c];
      if (cell.width > 0) {
        fill_rect(image, x, y, x + cell.width, y + cell.height, kCell);
        blit(image, cell, x, y);
      }
      x += at.widths[c] + kGap;
    }
    y += at.heights[r] + kGap;
  }
  if (sheet.color_bar)
    draw_color_bar(image, *sheet.color_bar, at.bar_x, at.top, std::min(at.bottom, at.top + 300));
  return image;
}

}  // namespace burnish
