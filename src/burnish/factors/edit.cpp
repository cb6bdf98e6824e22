// SPDX-License-Identifier: Apache-2.0
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

// Returns the place in [0, 1] whose value moves to u when the angle's tangent is multiplied by `factor`.
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

// Widens a table of logarithms whose x runs over theta_h, by resampling its rows.
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

// Widens a disk of logarithms along its radii, by bilinear resampling.
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

// Returns a lobe's mean albedo at scale 1, over views equally spaced in cos^2 up to 60 degrees and turned by the
// golden angle.
std::vector<double> albedo_of(const FactoredBrdf& model, std::vector<FactorUse> factors) {
  const auto channels = model.channels();
  const FactoredBrdf lobe(channels, {model.tables().begin(), model.tables().end()},
                          {{.scale = std::vector<double>(channels, 1), .factors = std::move(factors)}});
  std::vector<double> sum(channels), f(channels);
  for (int view = 0; view < kViews; ++view) {
    // The albedo integrates f cos(theta_i) over the half vector quadrature of each view.
    const double theta_o = std::acos(std::sqrt(1 - 0.75 * (view + 0.5) / kViews));
    const Vec3 wo = spherical_direction(theta_o, kGoldenAngle * view);
    for (const auto& [wi, weight] : half_vector_quadrature(wo, 24, 96)) {
      lobe.eval(wi, wo, f);
      for (std::size_t c = 0; c < channels; ++c) sum[c] += f[c] * wi.z * weight / kViews;
    }
  }
  return sum;
}

// Turns a colour about the grey axis by an angle, with less chroma where a channel would leave [0, 1], or [0, its
// largest].
std::vector<double> turned(std::span<const double> rgb, double angle) {
  const double mean = (rgb[0] + rgb[1] + rgb[2]) / 3, most = std::max(1.0, std::ranges::max(rgb));
  const double cosine = std::cos(angle), sine = std::sin(angle) / std::sqrt(3.0);
  std::vector<double> result(3);
  double part = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    // The rotation acts on the chroma, the difference to grey. `part` is how much of it stays inside the range.
    result[c] = cosine * (rgb[c] - mean) + sine * (rgb[(c + 2) % 3] - rgb[(c + 1) % 3]);
    if (result[c] < 0) part = std::min(part, -mean / result[c]);
    if (result[c] > 0) part = std::min(part, (most - mean) / result[c]);
  }
  for (double& r : result) r = std::max(mean + part * r, 0.0);
  return result;
}

void turn(const FactoredBrdf& model, Lobe& lobe, double angle) {
  // The lobe's albedo colour is turned, and its scale takes the ratio to the albedo at scale 1.
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

  // Tables are stored from logarithms, so everything becomes one.
  for (Table& table : tables)
    std::ranges::transform(table.values, table.values.begin(), [](float v) { return std::log(v); });
  for (Lobe& lobe : lobes)
    for (double& s : lobe.scale) s = std::log(s);  // the logarithm of 0 is -inf, which becomes 0 again
  widen(model, tables, edit.roughness);
  return from_log_tables(model.channels(), std::move(tables), std::move(lobes));
}

}  // namespace burnish
