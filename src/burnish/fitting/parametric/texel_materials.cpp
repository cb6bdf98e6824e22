// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <burnish/fitting/parametric/picture_pairs.h>
#include <burnish/fitting/parametric/texel_materials.h>
#include <burnish/math/k_means.h>
#include <burnish/math/parallel.h>
#include <burnish/math/srgb.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/gltf_material.h>

namespace burnish {

namespace {

constexpr int kExposureSize = 64;  // of the pictures that tell what is white
constexpr double kDark = 0.02;     // of white: what is darker is not weighted more
// Squared errors of x times white count as of its root, and beyond white less by x to this: pictures are saturated
// there, but highlights have to be found. Eight RGL materials by themselves: 0 leaves mirrors far off (7.7 dB), 1 loses
// a mirror's highlight altogether.
constexpr double kBeyondWhite = 0.75;
constexpr std::size_t kJudged = 1000;  // texels, at most

// Roughnesses and metals that are tried, of these first every so many-th.
constexpr int kRoughnesses = 125, kMetals = 17, kRoughStep = 4, kMetalStep = 4;
constexpr double kMinRoughness = 0.03;

// Texels are grouped by their weights, of at most so many texels.
constexpr std::size_t kGroups = 8, kGroupedTexels = 4000;
constexpr double kPull = 0.02;  // to a group's own material, of the square of what is fitted

double roughness_of(int step) {
  return kMinRoughness + (1 - kMinRoughness) * step / (kRoughnesses - 1);
}
double metal_of(int step) {
  return static_cast<double>(step) / (kMetals - 1);
}

/// A material without colour is linear in base_color and in metallic: base_color times ((1 - m) diffuse + m metal) plus
/// (1 - m) gloss + m edge. Which of a roughness's functions stands where.
enum Part { kDiffuse, kMetal, kGloss, kEdge, kParts };

/// The products that texels need of one roughness.
struct Products {
  std::array<std::array<double, kParts>, kParts> own;
  std::vector<std::array<double, 3 * kParts>> lobes;  ///< [lobe][part][channel]
};

struct Found {
  double error = std::numeric_limits<double>::infinity(), metallic = 0, roughness = 1;
  std::array<double, 3> color{};
};

/// A lobe weight a channel, those of a grey map three times the same.
using TexelWeights = std::vector<SurfaceMap::Value>;

TexelWeights weights_of(const SpatialBrdf& surface, std::size_t texel) {
  const auto width = static_cast<std::size_t>(surface.width());
  TexelWeights weights(surface.own_lobes());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const SurfaceMap& map = surface.maps().weights[k];
    weights[k] = map.texel(static_cast<int>(texel % width), static_cast<int>(texel / width));
    if (map.channels() == 1) weights[k].fill(weights[k][0]);
  }
  return weights;
}

/// The lobes with these weights.
FactoredBrdf material_of(const SpatialBrdf& surface, const TexelWeights& weights) {
  const FactoredBrdf own = surface.own_model();
  std::vector<Lobe> lobes(own.lobes().begin(), own.lobes().end());
  for (std::size_t k = 0; k < lobes.size(); ++k)
    for (std::size_t c = 0; c < lobes[k].scale.size(); ++c)
      lobes[k].scale[c] *= static_cast<double>(weights[k][c]);
  return FactoredBrdf(own.channels(), {own.tables().begin(), own.tables().end()}, std::move(lobes));
}

/// Finds materials of texels that resemble one. Functions over the pairs are as they are seen of it: times cos(theta_i)
/// and the root of the pixel's weight.
class Fitter {
 public:
  Fitter(const SpatialBrdf& surface, const TexelWeights& typical) : surface_(surface) {
    const FactoredBrdf material = material_of(surface, typical);
    pairs_ = picture_pairs(material, Scorer(material, {.count = 1, .image_size = kExposureSize}).exposure());
    for (std::size_t i = 0; i < pairs_.pairs.size(); ++i) {
      double f = 0;
      for (std::size_t c = 0; c < 3; ++c) f += std::max(pairs_.values[3 * i + c], 0.0) / 3;
      const double cosine = pairs_.pairs[i].wi.z, x = pairs_.exposure * f * cosine;
      scales_.push_back(
          cosine * std::sqrt(pairs_.weights[i] / ((x + kDark) * std::pow(std::max(x, 1.0), kBeyondWhite))));
    }
    find_lobes();
    products_.resize(kRoughnesses);
    for_each_chunk(kRoughnesses, 1, [&](std::size_t r, std::size_t, std::size_t) {
      products_[r] = products_at(static_cast<int>(r));
    });
    typical_ = nearest(typical);
  }

  /// Finds the material of one texel's weights. If two materials are equally near, the one more like the typical one
  /// is taken.
  Found nearest(const TexelWeights& weights) const {
    std::array<double, 3> square{};
    for (std::size_t k = 0; k < lobes_.size(); ++k)
      for (std::size_t l = 0; l < lobes_.size(); ++l)
        for (std::size_t c = 0; c < 3; ++c)
          square[c] += static_cast<double>(weights[k][c]) * static_cast<double>(weights[l][c]) *
                       between_[k * lobes_.size() + l][c];
    Found best;
    int best_rough = 0, best_metal = 0;
    const auto try_all = [&](int rough_begin, int rough_end, int rough_step, int metal_begin, int metal_end,
                             int metal_step) {
      for (int r = rough_begin; r < rough_end; r += rough_step) {
        const std::array<double, 3 * kParts> with = texel_products(r, weights);
        for (int m = metal_begin; m < metal_end; m += metal_step) {
          Found found = at(r, m, square, with);
          if (typical_)
            found.error += kPull * (square[0] + square[1] + square[2]) *
                           (std::pow(found.metallic - typical_->metallic, 2) +
                            std::pow(found.roughness - typical_->roughness, 2));
          if (!(found.error < best.error)) continue;
          best = found;
          best_rough = r;
          best_metal = m;
        }
      }
    };
    try_all(0, kRoughnesses, kRoughStep, 0, kMetals, kMetalStep);
    try_all(std::max(0, best_rough - kRoughStep), std::min(kRoughnesses, best_rough + kRoughStep + 1), 1,
            std::max(0, best_metal - kMetalStep), std::min(kMetals, best_metal + kMetalStep + 1), 1);
    return best;
  }

  /// Mean squared difference of what lit spheres show of a texel and of a material.
  double shown_error(const TexelWeights& weights, const GltfMaterial& material) const {
    const FactoredBrdf brdf = material_of(surface_, weights);
    const PicturePairs own = picture_pairs(brdf, pairs_.exposure);
    return own.mean_squared_error(own.shown_of(material));
  }

 private:
  void find_lobes() {
    for (std::size_t k = 0; k < surface_.own_lobes(); ++k) {
      const FactoredBrdf lobe = lobe_alone(surface_.lobes(), k);
      std::vector<std::array<double, 3>>& values = lobes_.emplace_back(pairs_.pairs.size());
      std::array<double, 3> f{};
      for (std::size_t i = 0; i < values.size(); ++i) {
        lobe.eval(pairs_.pairs[i].wi, pairs_.pairs[i].wo, std::span(f).first(lobe.channels()));
        for (std::size_t c = 0; c < 3; ++c) values[i][c] = scales_[i] * f[lobe.channels() == 1 ? 0 : c];
      }
    }
    for (const auto& a : lobes_)
      for (const auto& b : lobes_) {
        std::array<double, 3>& sum = between_.emplace_back();
        for (std::size_t i = 0; i < a.size(); ++i)
          for (std::size_t c = 0; c < 3; ++c) sum[c] += a[i][c] * b[i][c];
      }
  }

  Products products_at(int step) const {
    Products products{.own = {}, .lobes = std::vector<std::array<double, 3 * kParts>>(lobes_.size())};
    const double roughness = roughness_of(step);
    const auto eval = [&](double color, double metallic, const DirectionPair& pair) {
      std::array<double, 3> f;
      GltfMaterial{.base_color = color, .metallic = metallic, .roughness = roughness}.eval(pair.wi, pair.wo,
                                                                                           f);
      return f[0];
    };
    for (std::size_t i = 0; i < pairs_.pairs.size(); ++i) {
      const DirectionPair& pair = pairs_.pairs[i];
      std::array<double, kParts> part;
      part[kGloss] = eval(0, 0, pair);
      part[kDiffuse] = eval(1, 0, pair) - part[kGloss];
      part[kEdge] = eval(0, 1, pair);
      part[kMetal] = eval(1, 1, pair) - part[kEdge];
      for (std::size_t a = 0; a < kParts; ++a) {
        part[a] *= scales_[i];
        for (std::size_t b = 0; b <= a; ++b) products.own[a][b] += part[a] * part[b];
        for (std::size_t k = 0; k < lobes_.size(); ++k)
          for (std::size_t c = 0; c < 3; ++c) products.lobes[k][3 * a + c] += part[a] * lobes_[k][i][c];
      }
    }
    for (std::size_t a = 0; a < kParts; ++a)
      for (std::size_t b = a + 1; b < kParts; ++b) products.own[a][b] = products.own[b][a];
    return products;
  }

  /// A texel's products with a roughness's parts, [part][channel].
  std::array<double, 3 * kParts> texel_products(int r, const TexelWeights& weights) const {
    const Products& products = products_[static_cast<std::size_t>(r)];
    std::array<double, 3 * kParts> with{};
    for (std::size_t k = 0; k < lobes_.size(); ++k)
      for (std::size_t a = 0; a < with.size(); ++a)
        with[a] += static_cast<double>(weights[k][a % 3]) * products.lobes[k][a];
    return with;
  }

  /// The best colour of a roughness and a share of metal.
  Found at(int r, int m, const std::array<double, 3>& square,
           const std::array<double, 3 * kParts>& with) const {
    const auto& own = products_[static_cast<std::size_t>(r)].own;
    const double metal = metal_of(m), rest = 1 - metal;
    // what the colour multiplies, and what is added to it
    const double scaled = rest * rest * own[kDiffuse][kDiffuse] + 2 * rest * metal * own[kDiffuse][kMetal] +
                          metal * metal * own[kMetal][kMetal],
                 added = rest * rest * own[kGloss][kGloss] + 2 * rest * metal * own[kGloss][kEdge] +
                         metal * metal * own[kEdge][kEdge],
                 both = rest * rest * own[kDiffuse][kGloss] +
                        rest * metal * (own[kDiffuse][kEdge] + own[kMetal][kGloss]) +
                        metal * metal * own[kMetal][kEdge];
    Found found{.error = 0, .metallic = metal, .roughness = roughness_of(r)};
    for (std::size_t c = 0; c < 3; ++c) {
      const double of_scaled = rest * with[3 * kDiffuse + c] + metal * with[3 * kMetal + c],
                   of_added = rest * with[3 * kGloss + c] + metal * with[3 * kEdge + c];
      const double color = scaled > 0 ? std::clamp((of_scaled - both) / scaled, 0.0, 1.0) : 0;
      found.color[c] = color;
      found.error += square[c] + added - 2 * of_added + color * (color * scaled - 2 * of_scaled + 2 * both);
    }
    return found;
  }

  const SpatialBrdf& surface_;
  PicturePairs pairs_;
  std::optional<Found> typical_;
  std::vector<double> scales_;
  std::vector<std::vector<std::array<double, 3>>> lobes_;  ///< [lobe][pair][channel]
  std::vector<std::array<double, 3>> between_;             ///< products of two lobes
  std::vector<Products> products_;                         ///< [roughness]
};

/// Texels of about the same weights, relative to the largest of each lobe.
class WeightGroups {
 public:
  WeightGroups(const SpatialBrdf& surface, std::size_t texels) : scales_(surface.own_lobes(), 0) {
    const std::size_t step = (texels + kGroupedTexels - 1) / kGroupedTexels;
    std::vector<TexelWeights> some;
    for (std::size_t t = 0; t < texels; t += step) some.push_back(weights_of(surface, t));
    for (const TexelWeights& weights : some)
      for (std::size_t k = 0; k < weights.size(); ++k)
        for (const float w : weights[k]) scales_[k] = std::max(scales_[k], static_cast<double>(w));
    for (double& scale : scales_)
      if (!(scale > 0)) scale = 1;
    Points points{.size = some.size(), .coordinates = 3 * scales_.size(), .values = {}};
    for (const TexelWeights& weights : some) {
      const std::vector<double> point = point_of(weights);
      points.values.insert(points.values.end(), point.begin(), point.end());
    }
    const Groups found = grouped(points, kGroups);
    for (std::size_t g = 0; g < kGroups; ++g) {
      if (found.sizes[g] == 0) continue;
      const auto centre = found.centres[g];
      centres_.emplace_back(centre.begin(), centre.end());
      TexelWeights& typical = typical_.emplace_back(scales_.size());
      for (std::size_t i = 0; i < centre.size(); ++i)
        typical[i / 3][i % 3] = static_cast<float>(centre[i] * scales_[i / 3]);
    }
  }

  /// The mean weights of each group.
  const std::vector<TexelWeights>& typical() const noexcept { return typical_; }

  std::size_t of(const TexelWeights& weights) const {
    const std::vector<double> point = point_of(weights);
    const auto nearer = [&](const auto& a, const auto& b) {
      return squared_distance(point, a) < squared_distance(point, b);
    };
    return static_cast<std::size_t>(std::ranges::min_element(centres_, nearer) - centres_.begin());
  }

 private:
  std::vector<double> point_of(const TexelWeights& weights) const {
    std::vector<double> point;
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (const float w : weights[k]) point.push_back(static_cast<double>(w) / scales_[k]);
    return point;
  }

  std::vector<double> scales_;  ///< of each lobe
  std::vector<std::vector<double>> centres_;
  std::vector<TexelWeights> typical_;
};

std::uint8_t byte_of(double x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

}  // namespace

TexelMaterials nearest_materials(const SpatialBrdf& surface) {
  TexelMaterials result{.width = surface.width(),
                        .height = surface.height(),
                        .base_color = {},
                        .metallic = {},
                        .roughness = {}};
  const std::size_t texels = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height);
  const WeightGroups groups(surface, texels);
  std::vector<Fitter> fitters;
  for (const TexelWeights& typical : groups.typical()) fitters.emplace_back(surface, typical);

  result.base_color.resize(3 * texels);
  result.metallic.resize(texels);
  result.roughness.resize(texels);
  const std::size_t step = (texels + kJudged - 1) / kJudged;
  std::vector<double> errors((texels + step - 1) / step);
  for_each_chunk(texels, 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const TexelWeights weights = weights_of(surface, t);
      const Fitter& fitter = fitters[groups.of(weights)];
      const Found found = fitter.nearest(weights);
      for (std::size_t c = 0; c < 3; ++c)
        result.base_color[3 * t + c] = byte_of(srgb_encoded(found.color[c]));
      result.metallic[t] = byte_of(found.metallic);
      result.roughness[t] = byte_of(found.roughness);
      if (t % step != 0) continue;
      // as the textures say it
      const auto linear = [&](std::size_t c) { return srgb_decoded(result.base_color[3 * t + c] / 255.0); };
      errors[t / step] =
          fitter.shown_error(weights, {.base_color = {linear(0), linear(1), linear(2)},
                                       .metallic = result.metallic[t] / 255.0,
                                       .roughness = std::max(kMinRoughness, result.roughness[t] / 255.0)});
    }
  });
  double sum = 0;
  for (const double error : errors) sum += error;
  result.psnr = -10 * std::log10(sum / static_cast<double>(errors.size()));
  return result;
}

}  // namespace burnish
