// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/albedo.h>
#include <burnish/surface/spatial_brdf.h>
#include <burnish/surface/widened_weights.h>

namespace burnish {

namespace {

void check_size(const SurfaceMap& map, const SurfaceMap& first) {
  if (map.width() != first.width() || map.height() != first.height())
    throw Error(fmt::format("surface: expected maps of one size, found {} x {} beside {} x {}", map.width(),
                            map.height(), first.width(), first.height()));
}

// Every texel within the unit disk; `least`: its vector is no shorter.
void check_vectors(const SurfaceMap& map, double least, const char* name) {
  constexpr double kRounding = 1e-3;  // of two halves
  if (map.channels() != 2 || map.format() != TableFormat::half)
    throw Error(fmt::format("surface: expected {} of two channels of halves, found others", name));
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const SurfaceMap::Value v = map.texel(x, y);
      const double length = std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]));
      if (length > 1 + kRounding || length < least)
        throw Error(fmt::format("surface: expected {} of a length from {} to 1, found {} in texel ({}, {})",
                                name, least, length, x, y));
    }
}

void check_weights(const SurfaceMap& map, std::size_t channels) {
  if (map.channels() != 1 && map.channels() != channels)
    throw Error(
        fmt::format("surface: expected weights of 1 or {} channels, found {}", channels, map.channels()));
  if (map.format() == TableFormat::unorm8) return;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      for (const float value : map.texel(x, y))
        if (value < 0)
          throw Error(fmt::format("surface: expected weights >= 0, found {} in texel ({}, {})", value, x, y));
}

/// Copies of one of `own` lobes each, those of a lobe together, by rising variance.
void check_widened(std::span<const WidenedLobe> widened, std::size_t own, const SurfaceMaps& maps) {
  if (!widened.empty() && !maps.normals)
    throw Error("surface: expected normals beside widened lobes, found none");
  for (std::size_t i = 0; i < widened.size(); ++i) {
    const WidenedLobe* const before = i > 0 ? &widened[i - 1] : nullptr;
    const bool follows = !before || before->lobe < widened[i].lobe ||
                         (before->lobe == widened[i].lobe && before->variance < widened[i].variance);
    if (!follows || widened[i].lobe >= own || !(widened[i].variance > 0) || !(widened[i].variance <= 1))
      throw Error(
          fmt::format("surface: expected widened lobes in the order of lobes and variances in (0, 1], found "
                      "lobe {} of variance {}",
                      widened[i].lobe, widened[i].variance));
  }
}

}  // namespace

ShadingFrame frame_about(Vec3 normal, Vec3 tangent) noexcept {
  ShadingFrame frame;
  frame.normal = normal;
  frame.tangent = normalize(tangent - dot(tangent, normal) * normal);
  frame.bitangent = cross(normal, frame.tangent);
  return frame;
}

namespace {

/// Some lobes with the tables that they look up.
FactoredBrdf lobes_alone(const FactoredBrdf& brdf, std::span<const Lobe> some) {
  std::vector<Lobe> lobes(some.begin(), some.end());
  std::vector<Table> tables;
  for (Lobe& lobe : lobes)
    for (FactorUse& use : lobe.factors) {
      const Table& table = brdf.table_of(use);
      const auto known = std::ranges::find(tables, table.name, &Table::name);
      use.table = static_cast<std::size_t>(known - tables.begin());
      if (known == tables.end()) tables.push_back(table);
    }
  return FactoredBrdf(brdf.channels(), std::move(tables), std::move(lobes));
}

}  // namespace

FactoredBrdf lobe_alone(const FactoredBrdf& brdf, std::size_t lobe) {
  return lobes_alone(brdf, brdf.lobes().subspan(lobe, 1));
}

FactoredBrdf SpatialBrdf::own_model() const {
  return widened_.empty() ? lobes_ : lobes_alone(lobes_, lobes_.lobes().first(own_lobes()));
}

SpatialBrdf::SpatialBrdf(FactoredBrdf lobes, SurfaceMaps maps, std::vector<WidenedLobe> widened)
    : lobes_(std::move(lobes)), maps_(std::move(maps)), widened_(std::move(widened)) {
  const std::size_t count = lobes_.lobes().size();
  if (channels() != 1 && channels() != 3)
    throw Error(fmt::format("surface: expected lobes of 1 or 3 channels, found {}", channels()));
  if (count < 1 || count > kMaxSurfaceLobes)
    throw Error(fmt::format("surface: expected 1 to {} lobes, found {}", kMaxSurfaceLobes, count));
  if (widened_.size() >= count || maps_.weights.size() != own_lobes())
    throw Error(fmt::format("surface: expected maps of weights for {} lobes, {} of them widened, found {}",
                            count, widened_.size(), maps_.weights.size()));
  for (const SurfaceMap& map : maps_.weights) {
    check_size(map, maps_.weights.front());
    check_weights(map, channels());
  }
  if (maps_.normals) {
    check_size(*maps_.normals, maps_.weights.front());
    check_vectors(*maps_.normals, 0, "normals");
  }
  if (maps_.tangents) {
    check_size(*maps_.tangents, maps_.weights.front());
    check_vectors(*maps_.tangents, 0.5, "tangents");
  }
  check_widened(widened_, own_lobes(), maps_);
  if (!widened_.empty()) maps_ = with_widened_weights(std::move(maps_), widened_);
  for (std::size_t j = 0; j < count; ++j) apart_.push_back(lobe_alone(lobes_, j));
}

SpatialBrdf::Weight SpatialBrdf::weight(std::size_t lobe, double u, double v, double lod) const noexcept {
  return weight(lobe, map_place(u, v, lod));
}

SpatialBrdf::Weight SpatialBrdf::weight(std::size_t lobe, const SurfaceMap::Place& at) const noexcept {
  const SurfaceMap& map = maps_.weights[lobe];
  Weight weight = map.sample(at);
  if (map.channels() == 1) weight.fill(weight[0]);
  return weight;
}

ShadingFrame SpatialBrdf::frame(double u, double v, double lod) const noexcept {
  return frame(map_place(u, v, lod));
}

ShadingFrame SpatialBrdf::frame(const SurfaceMap::Place& at) const noexcept {
  if (!maps_.normals && !maps_.tangents) return {};
  Vec3 normal{0, 0, 1}, tangent{1, 0, 0};
  if (maps_.normals) {
    const SurfaceMap::Value n = maps_.normals->sample(at);
    const double x = static_cast<double>(n[0]), y = static_cast<double>(n[1]);
    normal = normalize({x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))});
  }
  if (maps_.tangents) {
    const SurfaceMap::Value t = maps_.tangents->sample(at);
    tangent = normalize({static_cast<double>(t[0]), static_cast<double>(t[1]), 0});
  }
  return frame_about(normal, tangent);
}

SpatialBrdf::Place SpatialBrdf::place(double u, double v, double lod) const noexcept {
  const SurfaceMap::Place at = map_place(u, v, lod);
  Place place{.frame = frame(at), .weights = {}};
  for (std::size_t j = 0; j < apart_.size(); ++j) place.weights[j] = weight(j, at);
  return place;
}

void SpatialBrdf::eval(const Place& place, Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  std::array<double, kMaxMapChannels> value;
  const std::span<double> lobe(value.data(), channels());
  for (std::size_t j = 0; j < apart_.size(); ++j) {
    apart_[j].eval(wi, wo, lobe);
    for (std::size_t c = 0; c < channels(); ++c) f[c] += static_cast<double>(place.weights[j][c]) * lobe[c];
  }
}

void SpatialBrdf::eval(double u, double v, double lod, Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const Place at = place(u, v, lod);
  eval(at, at.frame.local(wi), at.frame.local(wo), f);
}

std::vector<Lobe> SpatialBrdf::scaled_lobes(std::size_t count, const SurfaceMap::Place& at) const {
  const std::span<const Lobe> some = lobes_.lobes().first(count);
  std::vector<Lobe> scaled(some.begin(), some.end());
  for (std::size_t j = 0; j < scaled.size(); ++j) {
    const Weight scale = weight(j, at);
    for (std::size_t c = 0; c < channels(); ++c) scaled[j].scale[c] *= static_cast<double>(scale[c]);
  }
  return scaled;
}

FactoredBrdf SpatialBrdf::at(double u, double v, double lod) const {
  return FactoredBrdf(channels(), {lobes_.tables().begin(), lobes_.tables().end()},
                      scaled_lobes(lobes_.lobes().size(), map_place(u, v, lod)));
}

FactoredBrdf SpatialBrdf::texel(int x, int y) const {
  if (x < 0 || y < 0 || x >= width() || y >= height())
    throw Error(fmt::format("texel: expected one of {} x {}, found ({}, {})", width(), height(), x, y));
  return lobes_alone(lobes_, scaled_lobes(own_lobes(), maps_.weights.front().place_of_texel(x, y)));
}

std::size_t SpatialBrdf::weight_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const SurfaceMap& map : std::span(maps_.weights).first(own_lobes())) bytes += map.texel_bytes();
  return bytes;
}

std::size_t SpatialBrdf::frame_bytes() const noexcept {
  return (maps_.normals ? maps_.normals->texel_bytes() : 0) +
         (maps_.tangents ? maps_.tangents->texel_bytes() : 0);
}

std::size_t SpatialBrdf::bytes() const noexcept {
  const std::size_t texels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  return texels * (weight_bytes() + frame_bytes()) + lobes_.bytes();
}

SurfaceAlbedo surface_albedo(const SpatialBrdf& surface) {
  // of each lobe from each direction
  std::vector<double> theta_i;
  for (const double theta_deg : {0.0, 30.0, 50.0, 65.0, 75.0}) theta_i.push_back(radians(theta_deg));
  const std::size_t lobes = surface.own_lobes(), channels = surface.channels();
  std::vector<std::vector<AlbedoAt>> curves(lobes);
  for (std::size_t j = 0; j < lobes; ++j) curves[j] = albedo_curve(lobe_alone(surface.lobes(), j), theta_i);
  std::size_t directions = theta_i.size();
  for (const auto& curve : curves) directions = std::max(directions, curve.size());

  // and of each texel, a row a chunk
  const auto width = surface.width(), height = surface.height();
  std::vector<SurfaceAlbedo> rows(static_cast<std::size_t>(height));
  for_each_chunk(rows.size(), 1, [&](std::size_t, std::size_t y, std::size_t) {
    SurfaceAlbedo& row = rows[y];
    for (int x = 0; x < width; ++x) {
      bool above = false;
      for (std::size_t d = 0; d < directions; ++d)
        for (std::size_t c = 0; c < channels; ++c) {
          double albedo = 0;
          for (std::size_t j = 0; j < lobes; ++j) {
            const SurfaceMap& map = surface.maps().weights[j];
            const AlbedoAt& at = curves[j][d % curves[j].size()];
            const SurfaceMap::Value weight = map.texel(x, static_cast<int>(y));
            albedo += static_cast<double>(weight[map.channels() == 1 ? 0 : c]) * at.albedo.albedo[c];
          }
          row.mean += albedo;
          above = above || albedo > 1;
          if (albedo <= row.largest) continue;
          row.largest = albedo;
          row.x = x;
          row.y = static_cast<int>(y);
          row.theta_i = theta_i[d % theta_i.size()];
        }
      row.above_one += above;
    }
  });
  SurfaceAlbedo all;
  for (const SurfaceAlbedo& row : rows) {
    const double mean = all.mean + row.mean;
    const std::size_t above = all.above_one + row.above_one;
    if (row.largest > all.largest) all = row;
    all.mean = mean;
    all.above_one = above;
  }
  all.mean /= static_cast<double>(width) * height * static_cast<double>(directions * channels);
  return all;
}

}  // namespace burnish
