// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <burnish/math/angles.h>
#include <burnish/surface/widened_lobes.h>

namespace burnish {

namespace {

constexpr std::size_t kProfileNodes = 800;
constexpr double kMaxTheta = 1.4;     // of theta_h, radians; farther out a copy is its lobe times a constant
constexpr double kPeakStep = 0.18;    // from one copy to the next
constexpr double kWorthwhile = 0.75;  // how much the last copy has to lower the peak at least
constexpr double kMinVariance = 2e-5;
constexpr int kRatioNodes = 128;
constexpr TableFormat kRatioFormat = TableFormat::half;

/// exp(-x) I_0(x) for x >= 0, off by at most 2e-7 [AbramowitzStegun, 9.8.1 and 9.8.2].
double scaled_bessel(double x) noexcept {
  const auto sum = [](std::span<const double> c, double t) {
    double value = 0;
    for (std::size_t i = c.size(); i-- > 0;) value = value * t + c[i];
    return value;
  };
  constexpr std::array kNear{1.0, 3.5156229, 3.0899424, 1.2067492, 0.2659732, 0.0360768, 0.0045813};
  constexpr std::array kFar{0.39894228,  0.01328592, 0.00225319,  -0.00157565, 0.00916281,
                            -0.02057706, 0.02635537, -0.01647633, 0.00392377};
  constexpr double kBorder = 3.75;
  if (x < kBorder) return std::exp(-x) * sum(kNear, (x / kBorder) * (x / kBorder));
  return sum(kFar, kBorder / x) / std::sqrt(x);
}

/// The profile of a lobe over tan(theta_h), the mean of some directions, and its blur by slopes of a variance.
class Profile {
 public:
  explicit Profile(const FactoredBrdf& lobe) {
    for (std::size_t i = 0; i < kProfileNodes; ++i) {
      const double part = static_cast<double>(i) / (kProfileNodes - 1), theta = kMaxTheta * part * part;
      slopes_.push_back(std::tan(theta));
      values_.push_back(mean_at(lobe, theta, i == 0 ? 1 : values_.back()));
    }
  }

  double at(double theta) const noexcept { return interpolated(std::tan(theta)); }
  /// The mean over slopes of this variance along each axis about that of theta, as of what is constant beyond the
  /// profile.
  double widened(double theta, double variance) const noexcept {
    const double t = std::tan(theta);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i + 1 < slopes_.size(); ++i) {
      const double u = 0.5 * (slopes_[i] + slopes_[i + 1]), off = u - t;
      const double weight = (slopes_[i + 1] - slopes_[i]) * u * std::exp(-off * off / (2 * variance)) *
                            scaled_bessel(u * t / variance);
      sum += 0.5 * weight * (values_[i] + values_[i + 1]);
      all += weight;
    }
    return all > 0 ? sum / all : at(theta);
  }

 private:
  double interpolated(double slope) const noexcept {
    const auto above = std::ranges::upper_bound(slopes_, slope);
    if (above == slopes_.end()) return values_.back();
    const auto i = static_cast<std::size_t>(above - slopes_.begin());
    if (i == 0) return values_.front();
    const double part = (slope - slopes_[i - 1]) / (slopes_[i] - slopes_[i - 1]);
    return values_[i - 1] + part * (values_[i] - values_[i - 1]);
  }

  // over theta_d and azimuths, of pairs above the horizon; `otherwise` where there are none
  static double mean_at(const FactoredBrdf& lobe, double theta, double otherwise) {
    const ShadingFrame about = frame_about({std::sin(theta), 0, std::cos(theta)}, {0, 1, 0});
    double sum = 0;
    int count = 0;
    std::vector<double> f(lobe.channels());
    for (const double theta_d : {0.15, 0.5, 0.9})
      for (const double phi : {0.0, kPi / 4, kPi / 2}) {
        const double along = std::sin(theta_d) * std::cos(phi), across = std::sin(theta_d) * std::sin(phi);
        const Vec3 side = along * about.tangent + across * about.bitangent,
                   middle = std::cos(theta_d) * about.normal;
        const Vec3 wi = middle + side, wo = middle - side;
        if (std::min(wi.z, wo.z) < 0.02) continue;
        lobe.eval(wi, wo, f);
        for (const double value : f) sum += value;
        ++count;
      }
    return count > 0 ? sum / count : otherwise;
  }

  std::vector<double> slopes_, values_;  // over theta_h, denser at the normal
};

/// A copy that a surface may get.
struct Copy {
  std::size_t lobe = 0;
  double variance = 0, peak = 0;
};

std::vector<Copy> copies_of(std::size_t lobe, const Profile& profile, double most) {
  std::vector<Copy> copies;
  double before = profile.at(0), least = kMinVariance;
  for (;;) {
    const double last = profile.widened(0, most);
    if (last > kWorthwhile * before) return copies;
    if (last > kPeakStep * before) {
      copies.push_back({lobe, most, before});
      return copies;
    }
    double low = std::log(least), high = std::log(most);
    constexpr int kHalvings = 30;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (profile.widened(0, std::exp(middle)) > kPeakStep * before ? low : high) = middle;
    }
    least = std::exp(high);
    copies.push_back({lobe, least, before});
    before = profile.widened(0, least);
  }
}

/// Half the trace of the covariance of all normals' x and y.
double variance_of(const SurfaceMap& normals) {
  std::array<double, 2> mean{};
  double square = 0;
  for (int y = 0; y < normals.height(); ++y)
    for (int x = 0; x < normals.width(); ++x) {
      const SurfaceMap::Value n = normals.texel(x, y);
      for (std::size_t c = 0; c < mean.size(); ++c) {
        mean[c] += static_cast<double>(n[c]);
        square += static_cast<double>(n[c]) * static_cast<double>(n[c]);
      }
    }
  const double count = static_cast<double>(normals.width()) * normals.height();
  return 0.5 * (square - (mean[0] * mean[0] + mean[1] * mean[1]) / count) / count;
}

std::string free_name(std::span<const Table> tables) {
  for (std::size_t i = 0;; ++i) {
    std::string name = fmt::format("widened{}", i);
    if (std::ranges::find(tables, name, &Table::name) == tables.end()) return name;
  }
}

}  // namespace

SpatialBrdf with_widened_lobes(const SpatialBrdf& surface) {
  if (!surface.maps().normals || !surface.widened().empty()) return surface;
  const double most = variance_of(*surface.maps().normals);
  if (!(most > kMinVariance)) return surface;
  const FactoredBrdf& brdf = surface.lobes();

  // which, and in the lobes' order
  std::vector<Profile> profiles;
  std::vector<Copy> copies;
  for (std::size_t j = 0; j < brdf.lobes().size(); ++j) {
    profiles.emplace_back(lobe_alone(brdf, j));
    for (const Copy& copy : copies_of(j, profiles.back(), most)) copies.push_back(copy);
  }
  std::ranges::stable_sort(copies, std::greater{}, &Copy::peak);
  copies.resize(std::min(copies.size(), kMaxSurfaceLobes - brdf.lobes().size()));
  std::ranges::sort(copies, {}, [](const Copy& copy) { return std::pair(copy.lobe, copy.variance); });

  // the table of each
  std::vector<Table> tables(brdf.tables().begin(), brdf.tables().end());
  std::vector<Lobe> lobes(brdf.lobes().begin(), brdf.lobes().end());
  std::vector<WidenedLobe> widened;
  for (const Copy& copy : copies) {
    Table ratio{.name = free_name(tables),
                .layout = {.width = kRatioNodes, .warp = {WarpKind::power, 0.5}, .warp_y = {}, .warp_z = {}},
                .channels = 1,
                .values = {},
                .format = kRatioFormat};
    std::vector<double> values;
    for (int x = 0; x < kRatioNodes; ++x) {
      const double theta =
          std::min(std::acos(std::min(node_direction(ratio.layout, x, 0).z, 1.0)), kMaxTheta);
      values.push_back(profiles[copy.lobe].widened(theta, copy.variance) / profiles[copy.lobe].at(theta));
    }
    const double largest = *std::ranges::max_element(values);
    for (const double value : values)
      ratio.values.push_back(static_cast<float>(std::max(value / largest, kTableFloor)));
    ratio.values = round_to_format(kRatioFormat, 1, ratio.values);
    Lobe lobe = lobes[copy.lobe];
    for (double& scale : lobe.scale) scale *= largest;
    lobe.factors.push_back(
        {.table = tables.size(), .projection = kProjectHalf, .projection_y = {}, .projection_z = {}});
    tables.push_back(std::move(ratio));
    lobes.push_back(std::move(lobe));
    widened.push_back({copy.lobe, copy.variance});
  }

  SurfaceMaps maps = surface.maps();
  return {FactoredBrdf(brdf.channels(), std::move(tables), std::move(lobes)), std::move(maps),
          std::move(widened)};
}

}  // namespace burnish
