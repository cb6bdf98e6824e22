#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/edit.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/half_vector_quadrature.h>

namespace burnish {

namespace {

constexpr int kViews = 32;
constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt(5))

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

// A lobe's mean albedo, were its scale 1: views equally spaced in cos^2 up to 60 degrees, turned by the golden angle.
std::vector<double> albedo_of(const FactoredBrdf& model, std::vector<FactorUse> factors) {
  const auto channels = model.channels();
  const FactoredBrdf lobe(channels, {model.tables().begin(), model.tables().end()},
                          {{.scale = std::vector<double>(channels, 1), .factors = std::move(factors)}});
  std::vector<double> sum(channels), f(channels);
  for (int view = 0; view < kViews; ++view) {
    const double theta_o = std::acos(std::sqrt(1 - 0.75 * (view + 0.5) / kViews));
    const Vec3 wo = spherical_direction(theta_o, kGoldenAngle * view);
    for (const auto& [wi, weight] : half_vector_quadrature(wo, 24, 96)) {
      lobe.eval(wi, wo, f);
      for (std::size_t c = 0; c < channels; ++c) sum[c] += f[c] * wi.z * weight / kViews;
    }
  }
  return sum;
}

// Turned about the grey axis, with less chroma where a channel would leave [0, 1], or [0, its largest].
std::vector<double> turned(std::span<const double> rgb, double angle) {
  const double mean = (rgb[0] + rgb[1] + rgb[2]) / 3, most = std::max(1.0, std::ranges::max(rgb));
  const double cosine = std::cos(angle), sine = std::sin(angle) / std::sqrt(3.0);
  std::vector<double> result(3);
  double part = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = cosine * (rgb[c] - mean) + sine * (rgb[(c + 2) % 3] - rgb[(c + 1) % 3]);
    if (result[c] < 0) part = std::min(part, -mean / result[c]);
    if (result[c] > 0) part = std::min(part, (most - mean) / result[c]);
  }
  for (double& r : result) r = std::max(mean + part * r, 0.0);
  return result;
}

void turn(const FactoredBrdf& model, Lobe& lobe, double angle) {
  const std::vector<double> unit = albedo_of(model, lobe.factors);
  std::vector<double> colour = unit;
  for (std::size_t c = 0; c < colour.size(); ++c) colour[c] *= lobe.scale[c];
  colour = turned(colour, angle);
  for (std::size_t c = 0; c < colour.size(); ++c) lobe.scale[c] = colour[c] / unit[c];
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
  for (const double hue : edit.hue) require("a hue", hue, -100, 100);
  std::vector<Table> tables(model.tables().begin(), model.tables().end());
  std::vector<Lobe> lobes(model.lobes().begin(), model.lobes().end());
  if (edit.hue.size() > 1 && edit.hue.size() != lobes.size())
    throw Error(fmt::format("edit: expected hues of {} lobes, found {}", lobes.size(), edit.hue.size()));
  for (std::size_t l = 0; !edit.hue.empty() && l < lobes.size(); ++l) {
    const double hue = edit.hue[edit.hue.size() == 1 ? 0 : l];
    if (hue == 0) continue;
    if (model.channels() != 3)
      throw Error(fmt::format("edit: expected three channels where a hue turns, found {}", model.channels()));
    turn(model, lobes[l], hue);
  }
  if (edit.roughness == 1) return {model.channels(), std::move(tables), std::move(lobes)};

  // everything as logarithms, which tables are stored from
  for (Table& table : tables)
    std::ranges::transform(table.values, table.values.begin(), [](float v) { return std::log(v); });
  for (Lobe& lobe : lobes)
    for (double& s : lobe.scale) s = std::log(s);  // of 0 it is -inf, and 0 again in the end
  widen(model, tables, edit.roughness);
  return from_log_tables(model.channels(), std::move(tables), std::move(lobes));
}

}  // namespace burnish
