#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/rgl_table.h>

namespace burnish {
namespace {

constexpr double kSmallestCosine = 1e-6;
constexpr double kSmallestSigma = std::numeric_limits<float>::min();
constexpr double kPhiTolerance = 1e-3;
constexpr int kLargestChannels = 1 << 16;

void require(bool condition, const char* expected) {
  if (!condition) throw Error(fmt::format("RGL table: expected {}", expected));
}

void require_finite(const std::vector<float>& values, float least, const char* name) {
  for (float value : values)
    if (!(std::isfinite(value) && value >= least))
      throw Error(fmt::format("RGL table: expected {} finite{}, found {}", name,
                              least == 0 ? " and >= 0" : "", static_cast<double>(value)));
}

void require_grid(const RglGrid& grid, std::size_t factor, const char* name) {
  if (grid.width < 2 || grid.height < 2 ||
      grid.values.size() !=
          factor * static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height))
    throw Error(fmt::format("RGL table: expected a {} of at least 2 by 2 nodes for every slice", name));
}

void require_increasing(const std::vector<float>& angles, const char* name) {
  if (angles.empty()) throw Error(fmt::format("RGL table: expected at least one {}", name));
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i] > angles[i - 1]))
      throw Error(fmt::format("RGL table: expected increasing {}, found {} after {}", name,
                              static_cast<double>(angles[i]), static_cast<double>(angles[i - 1])));
}

/// Where x lies between increasing nodes: lower index and weight of the upper; clamped at the ends.
std::pair<std::uint32_t, double> locate(const std::vector<float>& nodes, double x) noexcept {
  const std::size_t n = nodes.size();
  std::size_t i = 0;
  while (i + 2 < n && static_cast<double>(nodes[i + 1]) <= x) ++i;
  if (n == 1) return {0, 0};
  const double a = static_cast<double>(nodes[i]), b = static_cast<double>(nodes[i + 1]);
  return {static_cast<std::uint32_t>(i), std::clamp((x - a) / (b - a), 0.0, 1.0)};
}

/// In [-pi, pi]; 0 of the normal, whatever the signs of its zeros.
double azimuth(Vec3 w) noexcept {
  return w.x == 0 && w.y == 0 ? 0 : std::atan2(w.y, w.x);
}

/// A bilinear lookup: index of the first corner of the cell and the weights of its corners 00, 10, 01, 11.
struct Bilinear {
  std::size_t index;
  std::array<double, 4> weight;

  Bilinear(Point2 p, int width, int height) noexcept {
    const double x = p.x * (width - 1), y = p.y * (height - 1);
    const int column = std::min(static_cast<int>(x), width - 2),
              row = std::min(static_cast<int>(y), height - 2);
    const double s = x - column, t = y - row;
    index =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
    weight = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  }
};

}  // namespace

Point2 rgl_square(double theta, double phi) noexcept {
  return {std::min(std::sqrt(theta * (2 / kPi)), 1.0), std::clamp((phi + kPi) / kTwoPi, 0.0, 1.0)};
}

double rgl_lookup(const RglGrid& grid, Point2 p) noexcept {
  const Bilinear at(p, grid.width, grid.height);
  const float* v = grid.values.data() + at.index;
  return at.weight[0] * static_cast<double>(v[0]) + at.weight[1] * static_cast<double>(v[1]) +
         at.weight[2] * static_cast<double>(v[grid.width]) +
         at.weight[3] * static_cast<double>(v[grid.width + 1]);
}

RglTable::RglTable(RglData data) : data_(std::move(data)) {
  const auto lambdas = data_.lambda_nm.size();
  require(data_.channels > 0 && data_.channels <= kLargestChannels, "1 to 65536 channels");
  require(lambdas == 0 ? data_.channels == 1 || data_.channels == 3
                       : static_cast<std::size_t>(data_.channels) == lambdas,
          "one channel, three, or one a wavelength");
  for (std::size_t k = 0; k < lambdas; ++k)
    require(std::isfinite(data_.lambda_nm[k]) && data_.lambda_nm[k] > (k > 0 ? data_.lambda_nm[k - 1] : 0),
            "increasing wavelengths");
  require_finite(data_.phi_i, -std::numeric_limits<float>::max(), "phi_i");
  require_finite(data_.theta_i, 0, "theta_i");
  require_increasing(data_.phi_i, "phi_i");
  require_increasing(data_.theta_i, "theta_i");
  require(static_cast<double>(data_.theta_i.back()) < kHalfPi + 1e-3, "theta_i up to pi/2");

  const std::size_t slices = data_.phi_i.size() * data_.theta_i.size();
  require_grid(data_.ndf, 1, "ndf");
  require_grid(data_.sigma, 1, "sigma");
  require_grid(data_.vndf, slices, "vndf");
  require_grid(data_.spectra, slices * static_cast<std::size_t>(data_.channels), "spectra");
  require_grid(data_.luminance, slices, "luminance");
  require_finite(data_.ndf.values, 0, "ndf");
  require_finite(data_.sigma.values, 0, "sigma");
  require_finite(data_.spectra.values, -std::numeric_limits<float>::max(), "spectra");
  require_finite(data_.luminance.values, -std::numeric_limits<float>::max(), "luminance");
  set_reduction();
  warp_ = ConditionalWarp2(data_.vndf.width, data_.vndf.height, data_.vndf.values);
  // negative noise carries no light; a dark slice is drawn from evenly
  std::vector<float> luminance = data_.luminance.values;
  const std::size_t slice = luminance.size() / slices;
  for (std::size_t first = 0; first < luminance.size(); first += slice) {
    const auto part = std::span(luminance).subspan(first, slice);
    for (float& value : part) value = std::max(value, 0.0f);
    if (std::ranges::max(part) == 0) std::ranges::fill(part, 1.0f);
  }
  luminance_warp_ = ConditionalWarp2(data_.luminance.width, data_.luminance.height, luminance);
}

void RglTable::set_reduction() {
  if (isotropic()) return;
  const double first = static_cast<double>(data_.phi_i.front()),
               last = static_cast<double>(data_.phi_i.back());
  const double times = std::round(kTwoPi / (last - first));
  require((times == 1 || times == 2 || times == 4) && std::abs(first) < 2 * kTwoPi &&
              last - first < kTwoPi + kPhiTolerance,
          "phi_i that cover the circle, a half or a quarter of it");
  reduction_ = static_cast<int>(times);
  cos_first_ = std::cos(first);
  sin_first_ = std::sin(first);
  if (reduction_ == 4) {
    require(std::abs(std::remainder(first, kHalfPi)) < kPhiTolerance, "a quarter of phi_i from an axis on");
    sign_x_ = std::cos(0.5 * (first + last));
    sign_y_ = std::sin(0.5 * (first + last));
  }
}

SliceMix RglTable::mix_at(double phi, double theta) const noexcept {
  const auto stride = static_cast<std::uint32_t>(data_.theta_i.size());
  const auto polar = locate(data_.theta_i, theta);
  SliceMix mix;
  const auto add = [&](std::uint32_t row, double weight) {
    for (const auto& [slice, w] :
         {std::pair(polar.first, 1 - polar.second), std::pair(polar.first + 1, polar.second)})
      if (weight * w > 0) {
        const auto i = static_cast<std::size_t>(mix.count++);
        mix.slice[i] = row * stride + slice;
        mix.weight[i] = weight * w;
      }
  };
  if (isotropic()) {
    add(0, 1);
    return mix;
  }

  const double first = static_cast<double>(data_.phi_i.front()),
               last = static_cast<double>(data_.phi_i.back());
  phi -= kTwoPi * std::floor((phi - first) / kTwoPi);
  const auto [p, p_weight] = locate(data_.phi_i, phi);
  if (phi <= last) {
    add(p, 1 - p_weight);
    add(p + 1, p_weight);
    return mix;
  }
  // Beyond the last phi_i the circle closes; of a half or a quarter only rounding leads here.
  const double gap = first + kTwoPi - last, beyond = gap > 0 ? std::min((phi - last) / gap, 1.0) : 0;
  const double to_first = reduction_ == 1 ? beyond : std::round(beyond);
  add(static_cast<std::uint32_t>(data_.phi_i.size() - 1), 1 - to_first);
  add(0, to_first);
  return mix;
}

/// The symmetry that takes a direction into the part of the circle that phi_i covers, its own inverse.
struct RglTable::Fold {
  double x = 1, y = 1;

  Vec3 operator()(Vec3 w) const noexcept { return {x * w.x, y * w.y, w.z}; }
};

RglTable::Fold RglTable::fold(Vec3 wi) const noexcept {
  if (reduction_ == 2 && wi.y * cos_first_ - wi.x * sin_first_ < 0) return {-1, -1};
  if (reduction_ == 4) return {wi.x * sign_x_ < 0 ? -1.0 : 1.0, wi.y * sign_y_ < 0 ? -1.0 : 1.0};
  return {};
}

/// Where two directions lie in the tables.
struct RglTable::Place {
  double theta_i, phi_i;  // folded
  Point2 half, sample;    // in the squares of vndf and of spectra
  SliceMix mix;
};

RglTable::Place RglTable::place_of(Vec3 wi, Vec3 wo) const noexcept {
  const Fold folded = fold(wi);
  wi = folded(wi);
  const Vec3 h = wi + folded(wo);  // its length does not matter
  Place place{.theta_i = std::atan2(std::sqrt(wi.x * wi.x + wi.y * wi.y), wi.z), .phi_i = 0};
  const double theta_h = std::atan2(std::sqrt(h.x * h.x + h.y * h.y), h.z);
  double phi_h = 0;
  if (isotropic()) {
    const double x = wi.x == 0 && wi.y == 0 ? 1 : wi.x;  // as azimuth()
    phi_h = std::atan2(x * h.y - wi.y * h.x, x * h.x + wi.y * h.y);
  } else {
    place.phi_i = azimuth(wi);
    phi_h = std::atan2(h.y, h.x);
  }
  place.half = rgl_square(theta_h, phi_h);
  place.mix = mix_at(place.phi_i, place.theta_i);
  place.sample = warp_.invert(place.half, place.mix);
  return place;
}

bool RglTable::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  assert(f.size() == static_cast<std::size_t>(data_.channels));
  std::fill(f.begin(), f.end(), 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return true;
  const auto [theta_i, phi_i, half, sample, mix] = place_of(wi, wo);

  double scale = 1 / std::max(wo.z, kSmallestCosine);
  if (data_.jacobian)  // [Dupuy 2018, sec. 4]
    scale *= rgl_lookup(data_.ndf, half) /
             (4 * std::max(rgl_lookup(data_.sigma, rgl_square(theta_i, phi_i)), kSmallestSigma));

  const auto channels = static_cast<std::size_t>(data_.channels);
  const auto width = static_cast<std::size_t>(data_.spectra.width);
  const std::size_t slice_size = width * static_cast<std::size_t>(data_.spectra.height);
  const Bilinear at(sample, data_.spectra.width, data_.spectra.height);
  const std::size_t corner[] = {0, 1, width, width + 1};
  for (std::size_t s = 0; s < static_cast<std::size_t>(mix.count); ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = scale * mix.weight[s] * at.weight[k];
      const float* value =
          data_.spectra.values.data() + (mix.slice[s] * slice_size + at.index + corner[k]) * channels;
      for (std::size_t c = 0; c < channels; ++c) f[c] += weight * static_cast<double>(value[c]);
    }
  return true;
}

DrawnDirection RglTable::sample_wo(Vec3 wi, Point2 u) const noexcept {
  const Fold folded = fold(wi);
  const Vec3 w = folded(wi);
  const double theta_i = std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z);
  const double phi_i = azimuth(w);
  const SliceMix mix = mix_at(phi_i, theta_i);
  const Point2 sample = luminance_warp_.warp(u, mix), half = warp_.warp(sample, mix);
  const double theta_h = half.x * half.x * kHalfPi, phi_h = half.y * kTwoPi - kPi;
  const Vec3 h = spherical_direction(theta_h, isotropic() ? phi_h + phi_i : phi_h);
  const double to_half = dot(w, h);
  const Vec3 wo = folded(2 * to_half * h - w);
  const double area = 2 * kPi * kPi * half.x * std::sin(theta_h) * 4 * to_half;  // solid angle over square
  if (!(area > 0 && wo.z > 0)) return {wo, 0};
  return {wo, luminance_warp_.pdf(sample, mix) * warp_.pdf(half, mix) / area};
}

double RglTable::pdf_wo(Vec3 wi, Vec3 wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return 0;
  const auto [theta_i, phi_i, half, sample, mix] = place_of(wi, wo);
  const double area = 2 * kPi * kPi * half.x * std::sin(half.x * half.x * kHalfPi) * 2 * length(wi + wo);
  return area > 0 ? luminance_warp_.pdf(sample, mix) * warp_.pdf(half, mix) / area : 0;
}

DirectionPair RglTable::node_directions(int phi, int theta, int row, int column) const noexcept {
  const double phi_i = isotropic() ? 0 : static_cast<double>(data_.phi_i[static_cast<std::size_t>(phi)]);
  const Vec3 wi =
      spherical_direction(static_cast<double>(data_.theta_i[static_cast<std::size_t>(theta)]), phi_i);
  const int slice = phi * static_cast<int>(data_.theta_i.size()) + theta;
  const Point2 half = warp_.warp({static_cast<double>(column) / (data_.spectra.width - 1),
                                  static_cast<double>(row) / (data_.spectra.height - 1)},
                                 {{static_cast<std::uint32_t>(slice)}, {1}, 1});
  const Vec3 h = spherical_direction(half.x * half.x * kHalfPi, half.y * kTwoPi - kPi);
  return {wi, normalize(2 * dot(wi, h) * h - wi)};
}

void RglTable::clamp_negatives() noexcept {
  for (RglGrid* grid : {&data_.spectra, &data_.luminance})
    for (float& value : grid->values) value = std::max(value, 0.0f);
}

}  // namespace burnish
