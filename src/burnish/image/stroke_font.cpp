// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <burnish/image/stroke_font.h>

namespace burnish {
namespace {

// A glyph is a list of strokes on a grid with capitals from y = 0 to the baseline at y = 8, small letters
// from y = 3 and descenders to y = 11. Each point is two hexadecimal digits, x and y. A stroke that begins
// with '~' is the uniform quadratic B-spline of its points that starts at the first and ends at the last;
// with 'o', the closed one; otherwise it is a polyline.
// clang-format off
constexpr std::array<std::string_view, 95> kAscii = {
    "", "0005 08", "0002 2022", "2117 4137 0353 0555", "~4140010444480807 2029", "5008 o00202303 o35555838",
    "~581210404305083855", "0002", "~20020628", "~00222608", "2125 0244 0442", "2327 0545", "171809", "0535",
    "08", "4008",
    // 0 to 9
    "o00404808", "123038", "~0200404408 0848", "~0100404414 ~1444480807", "38300545", "400004 ~041343480807",
    "~400006 o03434808", "004018", "o00404404 o04444808", "~084842 o00404505",
    // : to @
    "04 08", "14 171809", "420548", "0444 0646", "024508", "~0100404325 28", "o23434626 ~43466660000858",
    // A to Z
    "083068 1555", "0800 ~002040442404 ~042454582808", "~525000085856", "0800 ~002050582808", "40000848 0434",
    "400008 0434", "~525000085855 5535", "0008 5058 0454", "0008", "~3033380806", "0008 5005 2358", "000848",
    "0800356068", "08005850", "o00606808", "0800 ~002050542404", "o00606808 4668", "0800 ~002050542404 2458",
    "~5150000454580807", "0060 3038", "~000408585450", "003860", "0028426880", "0058 5008", "003460 3438",
    "00500858",
    // [ to `
    "20000a2a", "0048", "00202a0a", "022042", "0959", "0011",
    // a to z
    "4348 o03434808", "0008 o03434808", "~444303084847", "4048 o03434808", "0545 ~454303084847",
    "~30101318 0333", "o03434808 ~43474b0b0a", "0008 ~0503434648", "0308 01", "~13181b0b 11",
    "0008 4306 1548", "~00040818", "0308 ~0503333638 ~3533636668", "0308 ~0503434648", "o03434808",
    "030b o03434808", "434b o03434808", "0308 ~050333", "~4443030645480807", "~10141838 0333",
    "4348 ~4648080503", "032843", "0328344863", "0348 4308", "0328 431b", "03430848",
    // { to ~
    "~30101505 ~05151a3a", "000b", "~00202535 ~35252a0a", "~05034644"};

constexpr std::pair<char32_t, std::string_view> kOthers[] = {
    {U'°', "o00202202"}, {U'±', "2226 0444 0848"}, {U'²', "~0100202204 0424"}, {U'·', "05"}, {U'×', "0448 4408"},
    {U'Δ', "08306808"}, {U'α', "~533808033358"}, {U'γ', "0327 43272b"}, {U'θ', "o00404808 0444"},
    {U'λ', "~00102448 2408"}, {U'μ', "030b 4348 ~4648080503"}, {U'π', "0353 1318 4348"}, {U'ρ', "o03434808 050b"},
    {U'σ', "o03434808 2353"}, {U'φ', "o03434808 212b"}, {U'–', "0555"}, {U'…', "08 28 48"}, {U'→', "0565 436547"},
    {U'−', "0545"}, {U'≤', "420446 0848"}, {U'≥', "024406 0848"}};
// clang-format on
constexpr std::string_view kUnknown = "0040480800";

std::string_view glyph_of(char32_t code) noexcept {
  if (code >= 32 && code < 127) return kAscii[code - 32];
  for (const auto& [other, glyph] : kOthers)
    if (other == code) return glyph;
  return kUnknown;
}

// The next code point, taken off the front; U+FFFD for what is no UTF-8.
char32_t next_code(std::string_view& text) noexcept {
  const auto lead = static_cast<unsigned char>(text.front());
  text.remove_prefix(1);
  if (lead < 0x80) return lead;
  const std::size_t follow = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : 1;
  if (lead < 0xc0 || text.size() < follow) return U'\uFFFD';
  char32_t code = lead & (0x3fu >> follow);
  for (std::size_t i = 0; i < follow; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0) != 0x80) return U'\uFFFD';
    code = code << 6 | (byte & 0x3fu);
  }
  text.remove_prefix(follow);
  return code;
}

double digit(char c) noexcept {
  return c <= '9' ? c - '0' : c - 'a' + 10;
}

Point middle(Point a, Point b) noexcept {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

// One quadratic Bezier arc from the end of `to`, its start not repeated.
void append_arc(std::vector<Point>& to, Point control, Point end) {
  constexpr int kPieces = 6;
  const Point start = to.back();
  for (int i = 1; i <= kPieces; ++i) {
    const double t = static_cast<double>(i) / kPieces, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
    to.push_back({a * start.x + b * control.x + c * end.x, a * start.y + b * control.y + c * end.y});
  }
}

std::vector<Point> smooth(std::span<const Point> points, bool closed) {
  std::vector<Point> curve;
  const std::size_t n = points.size();
  if (closed) {
    curve.push_back(middle(points[n - 1], points[0]));
    for (std::size_t i = 0; i < n; ++i) append_arc(curve, points[i], middle(points[i], points[(i + 1) % n]));
  } else {
    curve.push_back(points[0]);
    for (std::size_t i = 1; i + 1 < n; ++i)
      append_arc(curve, points[i], i + 2 == n ? points[n - 1] : middle(points[i], points[i + 1]));
  }
  return curve;
}

}  // namespace

TextStrokes text_strokes(std::string_view text) {
  constexpr double kSpacing = 2.25, kSpace = 1.75, kDigitWidth = 4, kBaseline = 8;
  // A glyph is strokes parted by blanks, each of points of two digits, x and y; `~` in front is an open curve
  // through middles, `o` a closed one.
  TextStrokes result;
  double pen = 0;
  while (!text.empty()) {
    const char32_t code = next_code(text);
    std::string_view glyph = glyph_of(code);
    double width = glyph.empty() ? kSpace : code >= U'0' && code <= U'9' ? kDigitWidth : 0;
    while (!glyph.empty()) {
      const std::string_view stroke = glyph.substr(0, glyph.find(' '));
      glyph.remove_prefix(std::min(glyph.size(), stroke.size() + 1));
      const bool closed = stroke[0] == 'o', curved = closed || stroke[0] == '~';
      std::vector<Point> points;
      for (std::size_t i = curved; i < stroke.size(); i += 2) {
        points.push_back({digit(stroke[i]), digit(stroke[i + 1]) - kBaseline});
        width = std::max(width, points.back().x);
      }
      if (curved) points = smooth(points, closed);
      for (Point& p : points) p.x += pen;
      result.strokes.push_back(std::move(points));
    }
    pen += width + kSpacing;
  }
  result.width = std::max(0.0, pen - kSpacing);
  return result;
}

}  // namespace burnish
