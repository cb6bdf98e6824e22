// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include <burnish/capture/ranks/sampled_texels.h>
#include <burnish/capture/surface_baselines.h>
#include <burnish/fitting/numerics/eigenvectors.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxTexels = 4096;
constexpr int kRoughnesses = 16, kNodes = 64;
constexpr double kMinAlpha = 0.03, kMaxAlpha = 0.8, kDielectric = 0.04;
constexpr double kGrey = 1 / 2.2, kLogFloor = 0.004;
constexpr std::size_t kNeighbours = 3;

/// Returns a table over a polar angle, filled with a function of its cosine. The largest value is 1; the second
/// result is what the values were divided by.
template <class Of>
std::pair<Table, double> line(const char* name, Warp warp, const Of& of) {
  Table table{
      .name = name, .layout = {.width = kNodes, .warp = warp, .warp_y = {}, .warp_z = {}}, .values = {}};
  std::vector<double> values;
  for (int x = 0; x < kNodes; ++x) values.push_back(of(std::max(0.0, node_direction(table.layout, x, 0).z)));
  const double most = *std::ranges::max_element(values);
  for (const double value : values) table.values.push_back(static_cast<float>(value / most));
  return {std::move(table), most};
}

/// Returns a diffuse lobe and a GGX lobe for each channel.
FactoredBrdf ggx_lobes(double alpha) {
  const double square = alpha * alpha;
  const auto [d, most_d] = line("d", {WarpKind::power, 0.5}, [&](double z) {
    const double base = z * z * (square - 1) + 1;
    return square / (kPi * base * base);
  });
  // g is G1 / (2 cos), so that the product of two is G1 G1 / (4 cos cos).
  const auto [g, most_g] =
      line("g", {}, [&](double z) { return 1 / (z + std::sqrt(square + (1 - square) * z * z)); });
  const auto [f, most_f] =
      line("f", {}, [](double z) { return kDielectric + (1 - kDielectric) * std::pow(1 - z, 5); });
  const auto use = [](std::size_t table, const Projection& projection) {
    return FactorUse{.table = table, .projection = projection, .projection_y = {}, .projection_z = {}};
  };
  std::vector<Lobe> lobes;
  for (std::size_t c = 0; c < kCaptureChannels; ++c) {
    Lobe diffuse{.scale = {0, 0, 0}, .factors = {}}, glossy = diffuse;
    diffuse.scale[c] = 1 / kPi;
    glossy.scale[c] = most_d * most_g * most_g * most_f;
    glossy.factors = {use(0, kProjectHalf), use(1, kProjectWo), use(1, kProjectWi),
                      use(2, kProjectDifference)};
    lobes.push_back(diffuse);
    lobes.push_back(glossy);
  }
  return FactoredBrdf(kCaptureChannels, {d, g, f}, std::move(lobes), TableFormat::single);
}

/// Compares the methods on one capture.
class Comparison {
 public:
  Comparison(Capture capture, const SurfaceFit& fit, const SurfaceFitOptions& options)
      : capture_(std::move(capture)), fit_(fit) {
    const std::size_t values = kMaxTexels * capture_.form().pictures.size() * kCaptureChannels;
    samples_ = sample_texels(capture_, values, options.tile_bytes, options.seed + 1, nullptr).samples;
    const SurfaceMaps& maps = fit.surface.brdf.maps();
    for (const auto& [x, y] : samples_.texels) {
      for (std::size_t j = 0; j < fit.surface.brdf.own_lobes(); ++j)
        weights_.push_back(maps.weights[j].texel(x, y)[0]);
      if (!maps.normals) continue;
      const SurfaceMap::Value n = maps.normals->texel(x, y);
      normals_.insert(normals_.end(), {n[0], n[1]});
    }
  }

  std::vector<BaselineScore> run() {
    const double bytes = fit_.report.bytes_a_texel;
    return {{"lobes", bytes, score(fit_.surface.brdf.own_model(), fits_with(weights_))},
            {"ggx", 7, ggx()},
            {"nearest", 2, nearest()},
            {"pca", std::floor(bytes), pca(static_cast<std::size_t>(bytes))}};
  }

 private:
  TexelFits fits_with(std::vector<float> weights) const {
    return {.weights = std::move(weights), .normals = normals_, .trust = {}, .costs = {}};
  }

  static std::optional<double> psnr(const std::vector<double>& means) {
    if (means.empty()) return std::nullopt;
    double sum = 0;
    for (const double mean : means) sum += mean / static_cast<double>(means.size());
    return -10 * std::log10(sum);
  }

  /// Returns the PSNR from the mean squares of the held-out pictures, over the sampled texels.
  std::optional<double> score(const FactoredBrdf& lobes, const TexelFits& fits) const {
    const TexelSolver solver(lobes, capture_.form(), fit_.report.exposure);
    return psnr_of(solver.errors(samples_, fits));
  }
  std::optional<double> psnr_of(const std::vector<TexelSolver::PictureError>& errors) const {
    std::vector<double> means;
    for (std::size_t p = 0; p < errors.size(); ++p)
      if (const auto mean = errors[p].seen_mean(); mean && capture_.form().pictures[p].held_out)
        means.push_back(*mean);
    return psnr(means);
  }

  /// Returns some of the sampled texels.
  TexelSamples only(const std::vector<std::size_t>& texels) const {
    TexelSamples part{.texels = {}, .pictures = samples_.pictures, .values = {}, .states = {}};
    for (const std::size_t t : texels) part.texels.push_back(samples_.texels[t]);
    for (std::size_t p = 0; p < samples_.pictures; ++p)
      for (const std::size_t t : texels) {
        const std::size_t pixel = p * samples_.size() + t;
        part.values.insert(part.values.end(), &samples_.values[kCaptureChannels * pixel],
                           &samples_.values[kCaptureChannels * pixel] + kCaptureChannels);
        part.states.push_back(samples_.states[pixel]);
        if (samples_.directions.empty()) continue;
        part.directions.insert(part.directions.end(), &samples_.directions[6 * pixel],
                               &samples_.directions[6 * pixel] + 6);
      }
    return part;
  }

  /// Scores each texel by the model that leaves the least error in the fitted pictures.
  std::optional<double> best_of(const std::vector<FactoredBrdf>& models) const {
    std::vector<TexelFits> fits;
    for (const FactoredBrdf& model : models)
      fits.push_back(TexelSolver(model, capture_.form(), fit_.report.exposure)
                         .solve(samples_, normals_, {.passes = 3, .costs = true}));
    std::vector<TexelSolver::PictureError> errors(samples_.pictures);
    for (std::size_t m = 0; m < models.size(); ++m) {
      std::vector<std::size_t> texels;
      TexelFits part;
      const std::size_t lobes = models[m].lobes().size();
      for (std::size_t t = 0; t < samples_.size(); ++t) {
        const auto best = std::ranges::min_element(fits, {}, [&](const TexelFits& f) { return f.costs[t]; });
        if (static_cast<std::size_t>(best - fits.begin()) != m) continue;
        texels.push_back(t);
        part.weights.insert(part.weights.end(), &fits[m].weights[t * lobes],
                            &fits[m].weights[t * lobes] + lobes);
        if (!normals_.empty())
          part.normals.insert(part.normals.end(), {normals_[2 * t], normals_[2 * t + 1]});
      }
      if (texels.empty()) continue;
      const auto of =
          TexelSolver(models[m], capture_.form(), fit_.report.exposure).errors(only(texels), part);
      for (std::size_t p = 0; p < errors.size(); ++p) errors[p] += of[p];
    }
    return psnr_of(errors);
  }

  std::optional<double> ggx() const {
    std::vector<FactoredBrdf> models;
    for (int k = 0; k < kRoughnesses; ++k)
      models.push_back(ggx_lobes(kMinAlpha * std::pow(kMaxAlpha / kMinAlpha, k / (kRoughnesses - 1.0))));
    return best_of(models);
  }

  std::optional<double> nearest() const {
    std::vector<FactoredBrdf> models;
    const FactoredBrdf lobes = fit_.surface.brdf.own_model();
    for (std::size_t j = 0; j < lobes.lobes().size(); ++j) models.push_back(lobe_alone(lobes, j));
    return best_of(models);
  }

  double log_value(std::size_t pixel, std::size_t c) const {
    const double x =
        fit_.report.exposure * static_cast<double>(samples_.values[kCaptureChannels * pixel + c]);
    return std::log(std::max(x, 0.0) + kLogFloor);
  }

  /// Returns the PSNR of the principal components; none if texels have no pictures in common.
  std::optional<double> pca(std::size_t components) const {
    if (capture_.form().own_directions) return std::nullopt;
    const auto& pictures = capture_.form().pictures;
    std::vector<std::size_t> fitted;
    for (std::size_t p = 0; p < pictures.size(); ++p)
      if (!pictures[p].held_out) fitted.push_back(p);
    const Eigen::MatrixXd modelled = principal_logs(fitted, components);
    std::vector<double> means;
    for (std::size_t p = 0; p < pictures.size(); ++p) {
      if (!pictures[p].held_out) continue;
      if (const auto mean = mean_square(p, nearest_pictures(p, fitted), modelled)) means.push_back(*mean);
    }
    return psnr(means);
  }

  /// Logarithms of the fitted pictures, rebuilt from the mean and that many components. Each column is a texel.
  Eigen::MatrixXd principal_logs(const std::vector<std::size_t>& fitted, std::size_t components) const {
    const auto rows = static_cast<Eigen::Index>(kCaptureChannels * fitted.size()),
               columns = static_cast<Eigen::Index>(samples_.size());
    Eigen::MatrixXd logs(rows, columns);
    for (std::size_t k = 0; k < fitted.size(); ++k)
      for (std::size_t t = 0; t < samples_.size(); ++t)
        for (std::size_t c = 0; c < kCaptureChannels; ++c)
          logs(static_cast<Eigen::Index>(kCaptureChannels * k + c), static_cast<Eigen::Index>(t)) =
              log_value(fitted[k] * samples_.size() + t, c);
    const Eigen::VectorXd mean = logs.rowwise().mean();
    logs.colwise() -= mean;
    const Eigen::MatrixXd basis = leading_eigenvectors(
        logs * logs.transpose(), std::min<Eigen::Index>(rows, static_cast<Eigen::Index>(components)));
    Eigen::MatrixXd modelled = basis * (basis.transpose() * logs);
    modelled.colwise() += mean;
    return modelled;
  }

  /// A fitted picture, by its place among the fitted ones, and its share of the mean.
  struct Neighbour {
    std::size_t place;
    double share;
  };

  /// The fitted pictures whose light and view are nearest to those of picture `p`.
  std::vector<Neighbour> nearest_pictures(std::size_t p, const std::vector<std::size_t>& fitted) const {
    const auto& pictures = capture_.form().pictures;
    std::vector<std::pair<double, std::size_t>> near;
    const Vec3 origin;
    for (std::size_t k = 0; k < fitted.size(); ++k) {
      const CapturePicture& other = pictures[fitted[k]];
      const Vec3 light = other.light.seen_from(origin) - pictures[p].light.seen_from(origin),
                 view = other.view.seen_from(origin) - pictures[p].view.seen_from(origin);
      near.emplace_back(dot(light, light) + dot(view, view), k);
    }
    const std::size_t count = std::min(kNeighbours, near.size());
    std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(count));
    near.resize(count);
    std::vector<Neighbour> nearest;
    for (const auto& [distance, k] : near) nearest.push_back({k, 1 / (distance + 1e-6)});
    return nearest;
  }

  /// The mean square error of picture `p`, as it is seen, against the mean of its neighbours' logarithms. None if all
  /// of its pixels are missing.
  std::optional<double> mean_square(std::size_t p, const std::vector<Neighbour>& neighbours,
                                    const Eigen::MatrixXd& modelled) const {
    const auto seen_as = [](double x) { return std::pow(std::clamp(x, 0.0, 1.0), kGrey); };
    double sum = 0;
    std::size_t values = 0;
    for (std::size_t t = 0; t < samples_.size(); ++t) {
      const std::size_t pixel = p * samples_.size() + t;
      if (samples_.states[pixel] == PixelState::missing || samples_.states[pixel] == PixelState::masked)
        continue;
      for (std::size_t c = 0; c < kCaptureChannels; ++c, ++values) {
        double log = 0, all = 0;
        for (const auto& [place, share] : neighbours) {
          log += share * modelled(static_cast<Eigen::Index>(kCaptureChannels * place + c),
                                  static_cast<Eigen::Index>(t));
          all += share;
        }
        const double value = std::exp(log_value(pixel, c)), found = std::exp(log / all),
                     shown = is_clipped(samples_.states[pixel], c) ? std::min(found, value) : found;
        const double off = seen_as(shown - kLogFloor) - seen_as(value - kLogFloor);
        sum += off * off;
      }
    }
    if (values == 0) return std::nullopt;
    return sum / static_cast<double>(values);
  }

  Capture capture_;
  const SurfaceFit& fit_;
  TexelSamples samples_;
  std::vector<float> weights_, normals_;
};

}  // namespace

std::vector<BaselineScore> score_surface_baselines(Capture capture, const SurfaceFit& fit,
                                                   const SurfaceFitOptions& options) {
  return Comparison(std::move(capture), fit, options).run();
}

}  // namespace burnish
