#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/edit.h>

namespace burnish {

namespace {

constexpr double kMinScale = 1e-30;  // for 0, which has no logarithm

void require(const char* what, double value, double least, double most) {
  if (!(value >= least && value <= most))
    throw Error(fmt::format("edit: expected {} in [{}, {}], found {}", what, least, most, value));
}

// Where along [0, 1] the value is found that `u` gets, the angle's tangent divided by `factor`.
double widened(double u, const Warp& warp, double factor) {
  return warp.forward(std::min(warp.inverse(u) / factor, 1.0));
}

struct Between {
  std::size_t low;
  double part;
};
Between between(double u, int nodes) {
  const double at = std::clamp(u, 0.0, 1.0) * (nodes - 1);
  const int low = std::min(static_cast<int>(at), nodes - 2);
  return {static_cast<std::size_t>(low), at - low};
}

// Logarithms of a table whose x runs over theta_h, resampled.
std::vector<float> widened_rows(const Table& table, double factor) {
  const auto width = static_cast<std::size_t>(table.layout.width),
             channels = static_cast<std::size_t>(table.channels);
  std::vector<float> result(table.values.size());
  for (std::size_t x = 0; x < width; ++x) {
    const double u = static_cast<double>(x) / static_cast<double>(width - 1);
    const auto [low, part] = between(widened(u, table.layout.warp, factor), table.layout.width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(table.layout.rows()); ++row)
      for (std::size_t c = 0; c < channels; ++c) {
        const float* const from = &table.values[(row * width + low) * channels + c];
        result[(row * width + x) * channels + c] =
            static_cast<float>((1 - part) * from[0] + part * from[channels]);
      }
  }
  return result;
}

// The same of a disk, along its radii.
std::vector<float> widened_disk(const Table& table, double factor) {
  const auto width = static_cast<std::size_t>(table.layout.width),
             channels = static_cast<std::size_t>(table.channels);
  std::vector<float> result(table.values.size());
  for (std::size_t y = 0; y < width; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const double px = 2.0 * static_cast<double>(x) / static_cast<double>(width - 1) - 1,
                   py = 2.0 * static_cast<double>(y) / static_cast<double>(width - 1) - 1;
      const double radius = std::min(std::hypot(px, py), 1.0);
      const double shrink = radius > 0 ? widened(radius, table.layout.warp, factor) / std::hypot(px, py) : 1;
      const auto [i, fx] = between((shrink * px + 1) / 2, table.layout.width);
      const auto [j, fy] = between((shrink * py + 1) / 2, table.layout.width);
      for (std::size_t c = 0; c < channels; ++c) {
        const auto at = [&](std::size_t k, std::size_t l) -> double {
          return table.values[(l * width + k) * channels + c];
        };
        result[(y * width + x) * channels + c] =
            static_cast<float>((1 - fy) * ((1 - fx) * at(i, j) + fx * at(i + 1, j)) +
                               fy * ((1 - fx) * at(i, j + 1) + fx * at(i + 1, j + 1)));
      }
    }
  return result;
}

// Turned about the grey axis.
std::vector<double> turned(const std::vector<double>& rgb, double angle) {
  const double mean = (rgb[0] + rgb[1] + rgb[2]) / 3, cosine = std::cos(angle),
               sine = std::sin(angle) / std::sqrt(3.0);
  std::vector<double> result(3);
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = std::max(mean + cosine * (rgb[c] - mean) + sine * (rgb[(c + 2) % 3] - rgb[(c + 1) % 3]), 0.0);
  return result;
}

void widen(const FactoredBrdf& model, std::vector<Table>& log_tables, double factor) {
  std::set<int> done;
  for (const Lobe& lobe : model.lobes())
    for (const FactorUse& use : lobe.factors) {
      if (use.projection != kProjectHalf || !done.insert(use.table).second) continue;
      Table& table = log_tables[static_cast<std::size_t>(use.table)];
      table.values =
          table.layout.shape == TableShape::disk ? widened_disk(table, factor) : widened_rows(table, factor);
    }
}

}  // namespace

FactoredBrdf edited(const FactoredBrdf& model, const Edit& edit) {
  require("a roughness", edit.roughness, 0.1, 10);
  require("a hue", edit.hue, -100, 100);
  if (edit.hue != 0 && model.channels() != 3)
    throw Error(fmt::format("edit: expected three channels where a hue turns, found {}", model.channels()));
  std::vector<Table> tables(model.tables().begin(), model.tables().end());
  std::vector<Lobe> lobes(model.lobes().begin(), model.lobes().end());
  if (edit.hue != 0)
    for (Lobe& lobe : lobes) lobe.scale = turned(lobe.scale, edit.hue);
  if (edit.roughness == 1) return {model.channels(), std::move(tables), std::move(lobes)};

  // everything as logarithms, which tables are stored from
  for (Table& table : tables)
    std::ranges::transform(table.values, table.values.begin(), [](float v) { return std::log(v); });
  for (Lobe& lobe : lobes)
    for (double& s : lobe.scale) s = std::log(std::max(s, kMinScale));
  widen(model, tables, edit.roughness);
  return from_log_tables(model.channels(), std::move(tables), std::move(lobes));
}

}  // namespace burnish
