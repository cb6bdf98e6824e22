#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/textures/texture.h>

namespace burnish {

namespace {

constexpr int kPoints = 4;  // of a texel's footprint, along each axis

// Sums over footprints: weight, and weight times value for every channel.
struct Sums {
  int width, height, channels;
  std::vector<double> weights, values;

  Sums(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        weights(static_cast<std::size_t>(w * h)),
        values(static_cast<std::size_t>(w * h * c)) {}
  void add(int x, int y, double weight, const double* value) {
    const auto i = static_cast<std::size_t>(y * width + x);
    weights[i] += weight;
    for (int c = 0; c < channels; ++c)
      values[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)] += weight * value[c];
  }
};

void check(const Table& table) {
  if (table.channels != 1 && table.channels != 3)
    throw Error(fmt::format("texture: expected a table of 1 or 3 channels, found {}", table.channels));
}

// The bilinear value at a place in cells, clamped to the table.
void value_at(const Table& table, double x, double y, double* value) {
  const auto cell = [](double at, int size) {
    at = std::clamp(at, 0.0, size - 1.0);
    const int low = std::min(static_cast<int>(at), std::max(size - 2, 0));
    return std::pair(low, at - low);
  };
  const auto [x0, fx] = cell(x, table.layout.width);
  const auto [y0, fy] = cell(y, table.layout.height);
  const auto texel = [&table](int i, int j, int c) {
    i = std::min(i, table.layout.width - 1);
    j = std::min(j, table.layout.height - 1);
    return static_cast<double>(
        table.values[static_cast<std::size_t>((j * table.layout.width + i) * table.channels + c)]);
  };
  for (int c = 0; c < table.channels; ++c)
    value[c] = (1 - fy) * ((1 - fx) * texel(x0, y0, c) + fx * texel(x0 + 1, y0, c)) +
               fy * ((1 - fx) * texel(x0, y0 + 1, c) + fx * texel(x0 + 1, y0 + 1, c));
}

// d(omega) over 2 pi along the warped axis u = forward(tan(theta / 2)): with t = tan(theta / 2),
// sin(theta) d(theta) = 4 t / (1 + t^2)^2 dt.
double axis_measure(const Warp& warp, double u) {
  if (u < 0 || u > 1) return 0;
  constexpr double kStep = 1e-4;
  const double low = std::max(u - kStep, 0.0), high = std::min(u + kStep, 1.0);
  const double t = warp.inverse(u), slope = (warp.inverse(high) - warp.inverse(low)) / (high - low);
  return 4 * t / ((1 + t * t) * (1 + t * t)) * slope;
}

double measure(const TableLayout& layout, double x, double y) {
  const double u = x / (layout.width - 1);
  if (layout.shape == TableShape::line) return axis_measure(layout.warp, u);
  const double v = y / (layout.height - 1);
  if (layout.shape == TableShape::grid) return axis_measure(layout.warp, u) * axis_measure(layout.warp_y, v);
  // d(omega) = sin(theta) d(theta) d(phi), area r dr d(phi)
  const double r = std::hypot(2 * u - 1, 2 * v - 1);
  return r > 1 ? 0 : axis_measure(layout.warp, r) / std::max(r, 1e-9);
}

// Footprints of half as many texels, shares of those they cut.
Sums halved(const Sums& from) {
  Sums to(std::max(from.width / 2, 1), std::max(from.height / 2, 1), from.channels);
  const auto share = [](int texel, int size, int small, int i) {
    const double low = static_cast<double>(i) * size / small,
                 high = static_cast<double>(i + 1) * size / small;
    return std::max(std::min(high, texel + 1.0) - std::max<double>(low, texel), 0.0);
  };
  std::vector<double> mean(static_cast<std::size_t>(from.channels));
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      for (int j = y * from.height / to.height; j < from.height; ++j) {
        const double row = share(j, from.height, to.height, y);
        if (row <= 0) break;
        for (int i = x * from.width / to.width; i < from.width; ++i) {
          const double part = row * share(i, from.width, to.width, x);
          if (part <= 0) break;
          const auto at = static_cast<std::size_t>(j * from.width + i);
          const double weight = from.weights[at];
          for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = from.values[at * mean.size() + c] / weight;
          to.add(x, y, part * weight, mean.data());
        }
      }
  return to;
}

// Levels below the first, appended face by face.
void add_levels(Texture& texture, Sums sums) {
  const auto channels = static_cast<std::size_t>(texture.channels);
  for (std::size_t level = 1; sums.width > 1 || sums.height > 1; ++level) {
    sums = halved(sums);
    if (texture.levels.size() == level) texture.levels.emplace_back();
    std::vector<float> values;
    for (std::size_t i = 0; i < sums.values.size(); ++i)
      values.push_back(static_cast<float>(sums.values[i] / sums.weights[i / channels]));
    values = round_to_format(texture.format, texture.channels, values);
    texture.levels[level].insert(texture.levels[level].end(), values.begin(), values.end());
  }
}

// A footprint beyond the horizon: so little that it counts only where nothing else does.
constexpr double kBeyond = 1e-12;

}  // namespace

Texture make_texture(const Table& table, bool mips) {
  check(table);
  const TableLayout& layout = table.layout;
  Texture texture{.format = table.format,
                  .channels = table.channels,
                  .width = layout.width,
                  .height = layout.height,
                  .levels = {table.values}};
  if (!mips) return texture;

  // points of every texel's footprint, weighed by what of the sphere they stand for
  Sums sums(layout.width, layout.height, table.channels);
  double value[3];
  const int rows = layout.height == 1 ? 1 : kPoints;
  for (int y = 0; y < layout.height; ++y)
    for (int x = 0; x < layout.width; ++x)
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < kPoints; ++i) {
          const double at_x = x - 0.5 + (i + 0.5) / kPoints,
                       at_y = rows == 1 ? 0 : y - 0.5 + (j + 0.5) / rows;
          value_at(table, at_x, at_y, value);
          sums.add(x, y, measure(layout, at_x, at_y) + kBeyond, value);
        }
  add_levels(texture, std::move(sums));
  return texture;
}

Vec3 cube_direction(int face, double x, double y) noexcept {
  switch (face) {  // [KTX2, cubemap orientation]
    case 0:
      return normalize({1, -y, -x});
    case 1:
      return normalize({-1, -y, x});
    case 2:
      return normalize({x, 1, y});
    case 3:
      return normalize({x, -1, -y});
    case 4:
      return normalize({x, -y, 1});
    default:
      return normalize({-x, -y, -1});
  }
}

Texture make_cube_map(const Table& table, int side, bool mips) {
  check(table);
  if (table.layout.shape == TableShape::grid)
    throw Error(fmt::format("cube map: expected a table of one direction, found the grid '{}'", table.name));
  if (side < 2 || side > 2048)
    throw Error(fmt::format("cube map: expected a side in [2, 2048], found {}", side));

  // below the horizon the table's rim goes on
  const int cells = table.layout.width - 1;
  const auto at_direction = [&](Vec3 w, double* value) {
    if (w.z < 0) w = normalize({w.x, w.y, 0});
    if (table.layout.shape == TableShape::line) {
      value_at(table, table.layout.warp.forward(tan_half_theta(w)) * cells, 0, value);
    } else {
      const DiskPoint p = to_disk(w, table.layout.warp);
      value_at(table, 0.5 * (p.x + 1) * cells, 0.5 * (p.y + 1) * cells, value);
    }
  };
  Texture texture{.format = table.format,
                  .channels = table.channels,
                  .width = side,
                  .height = side,
                  .faces = 6,
                  .levels = {{}}};
  double value[3];
  const auto place = [&](double i) { return 2 * i / side - 1; };
  for (int face = 0; face < 6; ++face) {
    std::vector<float> values;
    // the value in each texel's middle, and points of its footprint for the smaller levels
    Sums sums(side, side, table.channels);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        at_direction(cube_direction(face, place(x + 0.5), place(y + 0.5)), value);
        values.insert(values.end(), value, value + table.channels);
        for (int j = 0; mips && j < kPoints; ++j)
          for (int i = 0; i < kPoints; ++i) {
            const double s = place(x + (i + 0.5) / kPoints), t = place(y + (j + 0.5) / kPoints);
            const Vec3 w = cube_direction(face, s, t);
            at_direction(w, value);  // a cell of the face is seen under area / (1 + s^2 + t^2)^(3/2)
            sums.add(x, y, w.z > 0 ? std::pow(1 + s * s + t * t, -1.5) : kBeyond, value);
          }
      }
    values = round_to_format(table.format, table.channels, values);
    texture.levels[0].insert(texture.levels[0].end(), values.begin(), values.end());
    if (mips) add_levels(texture, std::move(sums));
  }
  return texture;
}

}  // namespace burnish
