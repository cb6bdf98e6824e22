// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/textures/texture.h>

namespace burnish {

namespace {

constexpr int kPoints = 4;  // of a texel's footprint, along each axis

using Sides = std::array<int, 3>;

// Sums over footprints: weight, and weight times value for every channel.
struct Sums {
  Sides sides;
  std::size_t channels;
  std::vector<double> weights, values;

  Sums(const Sides& s, int c)
      : sides(s),
        channels(c),
        weights(static_cast<std::size_t>(s[0] * s[1] * s[2])),
        values(static_cast<std::size_t>(s[0] * s[1] * s[2] * c)) {}
  int index(int x, int y, int z) const noexcept { return (z * sides[1] + y) * sides[0] + x; }
  void add(int texel, double weight, const double* value) {
    const auto i = static_cast<std::size_t>(texel);
    weights[i] += weight;
    for (std::size_t c = 0; c < channels; ++c) values[i * channels + c] += weight * value[c];
  }
};

void check(const Table& table) {
  if (table.channels != 1 && table.channels != 3)
    throw Error(fmt::format("texture: expected a table of 1 or 3 channels, found {}", table.channels));
}

Sides sides_of(const TableLayout& layout) noexcept {
  return {layout.width, layout.height, layout.depth};
}

// The interpolated value at a place in cells, clamped to the table.
void value_at(const Table& table, const std::array<double, 3>& place, double* value) {
  const Sides sides = sides_of(table.layout);
  int low[3];
  double part[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = std::clamp(place[k], 0.0, sides[k] - 1.0);
    low[k] = std::min(static_cast<int>(at), std::max(sides[k] - 2, 0));
    part[k] = at - low[k];
  }
  std::fill_n(value, table.channels, 0.0);
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int node[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const int up = corner >> k & 1;
      weight *= up ? part[k] : 1 - part[k];
      node[k] = low[k] + up;
    }
    if (weight == 0) continue;
    const int first = ((node[2] * sides[1] + node[1]) * sides[0] + node[0]) * table.channels;
    for (std::size_t c = 0; c < table.channels; ++c)
      value[c] += weight * static_cast<double>(table.values[static_cast<std::size_t>(first + c)]);
  }
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

double measure(const TableLayout& layout, const std::array<double, 3>& place) {
  const double u = place[0] / (layout.width - 1);
  if (layout.shape == TableShape::line) return axis_measure(layout.warp, u);
  const double v = place[1] / (layout.height - 1);
  if (layout.shape == TableShape::disk) {
    // d(omega) = sin(theta) d(theta) d(phi), area r dr d(phi)
    const double r = std::hypot(2 * u - 1, 2 * v - 1);
    return r > 1 ? 0 : axis_measure(layout.warp, r) / std::max(r, 1e-9);
  }
  const double flat = axis_measure(layout.warp, u) * axis_measure(layout.warp_y, v);
  return layout.shape == TableShape::grid ? flat
                                          : flat * axis_measure(layout.warp_z, place[2] / (layout.depth - 1));
}

// The part of a level's texel that belongs to each texel of the level above that it is cut from, along one axis.
struct LevelShare {
  int from, to;
  double share;
};
std::vector<LevelShare> shares_of(int size, int small) {
  std::vector<LevelShare> shares;
  for (int to = 0; to < small; ++to) {
    const double low = static_cast<double>(to) * size / small,
                 high = static_cast<double>(to + 1) * size / small;
    for (int from = to * size / small; from < size && from < high; ++from)
      shares.push_back({from, to, std::min(high, from + 1.0) - std::max<double>(low, from)});
  }
  return shares;
}

// Footprints of half as many texels, shares of those they cut.
Sums halved(const Sums& from) {
  Sides small;
  std::array<std::vector<LevelShare>, 3> shares;
  for (std::size_t k = 0; k < 3; ++k) {
    small[k] = std::max(from.sides[k] / 2, 1);
    shares[k] = shares_of(from.sides[k], small[k]);
  }
  Sums to(small, from.channels);
  std::vector<double> mean(from.channels);
  for (const LevelShare& z : shares[2])
    for (const LevelShare& y : shares[1])
      for (const LevelShare& x : shares[0]) {
        const auto at = static_cast<std::size_t>(from.index(x.from, y.from, z.from));
        const double weight = from.weights[at];
        for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = from.values[at * mean.size() + c] / weight;
        to.add(to.index(x.to, y.to, z.to), x.share * y.share * z.share * weight, mean.data());
      }
  return to;
}

// Levels below the first, appended face by face.
void add_levels(Texture& texture, Sums sums) {
  const auto channels = texture.channels;
  for (std::size_t level = 1; std::ranges::max(sums.sides) > 1; ++level) {
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
                  .depth = layout.shape == TableShape::volume ? layout.depth : 0,
                  .levels = {table.values}};
  if (!mips) return texture;

  // points of every texel's footprint, weighed by what of the sphere they stand for
  const Sides sides = sides_of(layout);
  Sums sums(sides, table.channels);
  double value[3];
  std::array<std::vector<double>, 3> points;  // along each axis, from a texel's middle
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < (sides[k] == 1 ? 1 : kPoints); ++i)
      points[k].push_back(sides[k] == 1 ? 0 : (i + 0.5) / kPoints - 0.5);
  for (int z = 0; z < sides[2]; ++z)
    for (int y = 0; y < sides[1]; ++y)
      for (int x = 0; x < sides[0]; ++x)
        for (const double dz : points[2])
          for (const double dy : points[1])
            for (const double dx : points[0]) {
              const std::array place{x + dx, y + dy, z + dz};
              value_at(table, place, value);
              sums.add(sums.index(x, y, z), measure(layout, place) + kBeyond, value);
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
  if (projection_count(table.layout.shape) > 1)
    throw Error(fmt::format("cube map: expected a table of one direction, found the {} '{}'",
                            to_string(table.layout.shape), table.name));
  if (side < 2 || side > 2048)
    throw Error(fmt::format("cube map: expected a side in [2, 2048], found {}", side));

  // below the horizon the table's rim goes on
  const int cells = table.layout.width - 1;
  const auto at_direction = [&](Vec3 w, double* value) {
    if (w.z < 0) w = normalize({w.x, w.y, 0});
    if (table.layout.shape == TableShape::line) {
      value_at(table, {table.layout.warp.forward(tan_half_theta(w)) * cells, 0, 0}, value);
    } else {
      const DiskPoint p = to_disk(w, table.layout.warp);
      value_at(table, {0.5 * (p.x + 1) * cells, 0.5 * (p.y + 1) * cells, 0}, value);
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
    Sums sums({side, side, 1}, table.channels);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        at_direction(cube_direction(face, place(x + 0.5), place(y + 0.5)), value);
        values.insert(values.end(), value, value + table.channels);
        for (int j = 0; mips && j < kPoints; ++j)
          for (int i = 0; i < kPoints; ++i) {
            const double s = place(x + (i + 0.5) / kPoints), t = place(y + (j + 0.5) / kPoints);
            const Vec3 w = cube_direction(face, s, t);
            at_direction(w, value);  // a cell of the face is seen under area / (1 + s^2 + t^2)^(3/2)
            sums.add(sums.index(x, y, 0), w.z > 0 ? std::pow(1 + s * s + t * t, -1.5) : kBeyond, value);
          }
      }
    values = round_to_format(table.format, table.channels, values);
    texture.levels[0].insert(texture.levels[0].end(), values.begin(), values.end());
    if (mips) add_levels(texture, std::move(sums));
  }
  return texture;
}

std::string level_bytes(const Texture& texture, const std::vector<float>& level) {
  const bool alpha = texture.channels == 3 && texture.format != TableFormat::rgb9e5;
  std::vector<float> values;
  for (std::size_t i = 0; alpha && i < level.size(); i += 3)
    values.insert(values.end(), {level[i], level[i + 1], level[i + 2], 1.0f});
  const std::vector<std::byte> bytes =
      pack(texture.format, alpha ? 4 : texture.channels, alpha ? values : level);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace burnish
