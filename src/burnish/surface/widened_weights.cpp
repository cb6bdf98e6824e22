// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <burnish/math/parallel.h>
#include <burnish/surface/widened_weights.h>

namespace burnish {

namespace {

/// Means over the texels that one covers: a lobe's weights, and their mean over the channels times the normal's x, y
/// and squared length of these.
struct Moments {
  std::array<double, kMaxMapChannels> weight{};
  double x = 0, y = 0, square = 0;

  void add(const Moments& other, double share) noexcept {
    for (std::size_t c = 0; c < weight.size(); ++c) weight[c] += share * other.weight[c];
    x += share * other.x;
    y += share * other.y;
    square += share * other.square;
  }
};

double mean_weight(const SurfaceMap::Value& weight, std::size_t channels) noexcept {
  double sum = 0;
  for (std::size_t c = 0; c < channels; ++c) sum += static_cast<double>(weight[c]);
  return sum / static_cast<double>(channels);
}

Moments moments_of(const SurfaceMap& weights, const SurfaceMap& normals, int x, int y) noexcept {
  const SurfaceMap::Value weight = weights.texel(x, y), normal = normals.texel(x, y);
  const double mean = mean_weight(weight, weights.channels()), nx = static_cast<double>(normal[0]),
               ny = static_cast<double>(normal[1]);
  Moments moments{.weight = {}, .x = mean * nx, .y = mean * ny, .square = mean * (nx * nx + ny * ny)};
  for (std::size_t c = 0; c < weights.channels(); ++c) moments.weight[c] = static_cast<double>(weight[c]);
  return moments;
}

/// Returns the moments of every texel of a level. `finer` are those of the level before, which level 0 does without.
std::vector<Moments> moments_of_level(const SurfaceMap& weights, const SurfaceMap& normals, std::size_t level,
                                      std::span<const Moments> finer) {
  const int width = weights.level_width(level), height = weights.level_height(level),
            from_width = weights.level_width(level - 1), from_height = weights.level_height(level - 1);
  std::vector<Moments> all(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for_each_chunk(static_cast<std::size_t>(height), 16, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) {
        const auto [x0, x1] = covered_texels(x, width, from_width);
        const auto [y0, y1] = covered_texels(y, height, from_height);
        Moments& sum =
            all[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        const double share = 1.0 / ((x1 - x0) * (y1 - y0));
        for (int j = y0; j < y1; ++j)
          for (int i = x0; i < x1; ++i)
            sum.add(level == 1 ? moments_of(weights, normals, i, j)
                               : finer[static_cast<std::size_t>(j) * static_cast<std::size_t>(from_width) +
                                       static_cast<std::size_t>(i)],
                    share);
      }
  });
  return all;
}

/// Returns the variance of the weights, about a normal and along each axis.
double variance_about(const Moments& m, double mean, const SurfaceMap::Value& normal) noexcept {
  const double nx = static_cast<double>(normal[0]), ny = static_cast<double>(normal[1]);
  if (!(mean > 0)) return 0;
  return std::max(0.0, 0.5 * ((m.square - 2 * (nx * m.x + ny * m.y)) / mean + nx * nx + ny * ny));
}

/// Returns the share of a weight that goes to variance `of`, the others being at `below` and `above`: a hat, flat
/// beyond the last.
double share_of(double variance, double below, double of, std::optional<double> above) noexcept {
  if (variance <= of) return of > below ? std::max(0.0, (variance - below) / (of - below)) : 1;
  return above ? std::max(0.0, (*above - variance) / (*above - of)) : 1;
}

}  // namespace

SurfaceMaps with_widened_weights(SurfaceMaps maps, std::span<const WidenedLobe> widened) {
  const std::size_t own = maps.weights.size(), levels = maps.weights.front().levels();
  const SurfaceMap& normals = *maps.normals;
  maps.weights.reserve(own + widened.size());
  for (std::size_t first = 0, last = 0; first < widened.size(); first = last) {
    const SurfaceMap weights = maps.weights[widened[first].lobe];
    while (last < widened.size() && widened[last].lobe == widened[first].lobe) ++last;
    // of the lobe and its copies, level by level
    std::vector<double> variances{0};
    for (std::size_t i = first; i < last; ++i) variances.push_back(widened[i].variance);
    const std::size_t channels = weights.channels();
    std::vector<std::vector<std::vector<float>>> values(variances.size());
    std::vector<Moments> moments;
    for (std::size_t l = 1; l < levels; ++l) {
      moments = moments_of_level(weights, normals, l, moments);
      const auto width = static_cast<std::size_t>(weights.level_width(l));
      for (auto& of : values) of.emplace_back(moments.size() * channels);
      for (std::size_t t = 0; t < moments.size(); ++t) {
        const Moments& m = moments[t];
        double mean = 0;
        for (std::size_t c = 0; c < channels; ++c) mean += m.weight[c] / static_cast<double>(channels);
        const double variance = variance_about(
            m, mean, normals.texel(static_cast<int>(t % width), static_cast<int>(t / width), l));
        for (std::size_t i = 0; i < variances.size(); ++i) {
          const double share =
              share_of(variance, i > 0 ? variances[i - 1] : 0, variances[i],
                       i + 1 < variances.size() ? std::optional(variances[i + 1]) : std::nullopt);
          for (std::size_t c = 0; c < channels; ++c)
            values[i][l - 1][channels * t + c] = static_cast<float>(share * m.weight[c]);
        }
      }
    }
    maps.weights[widened[first].lobe] = weights.with_coarse_levels(values[0]);
    const std::vector<float> none(static_cast<std::size_t>(weights.width()) *
                                  static_cast<std::size_t>(weights.height()) * channels);
    for (std::size_t i = 1; i < variances.size(); ++i)
      maps.weights.push_back(SurfaceMap(weights.width(), weights.height(), channels, weights.format(),
                                        weights.scale(), std::span<const float>(none))
                                 .with_coarse_levels(values[i]));
  }
  return maps;
}

}  // namespace burnish
