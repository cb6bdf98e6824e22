// SPDX-License-Identifier: Apache-2.0
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

constexpr double kMinCosine = 1e-6;
constexpr double kMinSigma = std::numeric_limits<float>::min();
constexpr double kPhiTolerance = 1e-3;
constexpr std::size_t kMaxChannels = 1 << 16;

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

/// Returns the lower index and the weight of the upper node for x among increasing nodes, clamped at the ends.
std::pair<std::uint32_t, double> locate(const std::vector<float>& nodes, double x) noexcept {
  const std::size_t n = nodes.size();
  std::size_t i = 0;
  while (i + 2 < n && static_cast<double>(nodes[i + 1]) <= x) ++i;
  if (n == 1) return {0, 0};
  const double a = static_cast<double>(nodes[i]), b = static_cast<double>(nodes[i + 1]);
  return {static_cast<std::uint32_t>(i), std::clamp((x - a) / (b - a), 0.0, 1.0)};
}

/// Returns theta_of by a square root, which costs less than hypot. w may have any length that is not tiny.
double polar_angle(Vec3 w) noexcept {
  return std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z);
}

/// Returns the azimuth in [-pi, pi]; 0 for the normal.
double azimuth(Vec3 w) noexcept {
  return is_pole(w) ? 0 : std::atan2(w.y, w.x);
}

/// Returns the solid angle of half vectors over the area of the unit square, dm / (du dv). With theta = pi/2 u^2 and
/// phi = 2 pi v - pi it is sin(theta) dtheta/du dphi/dv = sin(theta) (pi u) (2 pi).
double solid_angle_over_area(Point2 half) noexcept {
  return 2 * kPi * kPi * half.x * std::sin(rgl_theta(half.x));
}

/// The cell of a grid that holds p in [0, 1]^2, for bilinear interpolation: index of its first corner and
/// the weights of its corners 00, 10, 01, 11.
struct GridCell {
  std::size_t index;
  std::array<double, 4> weight;

  GridCell(Point2 p, int width, int height) noexcept {
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
  const GridCell at(p, grid.width, grid.height);
  const float* v = grid.values.data() + at.index;
  return at.weight[0] * static_cast<double>(v[0]) + at.weight[1] * static_cast<double>(v[1]) +
         at.weight[2] * static_cast<double>(v[grid.width]) +
         at.weight[3] * static_cast<double>(v[grid.width + 1]);
}

RglTable::RglTable(RglData data) : data_(std::move(data)) {
  const auto lambdas = data_.lambda_nm.size();
  require(data_.channels > 0 && data_.channels <= kMaxChannels, "1 to 65536 channels");
  require(lambdas == 0 ? data_.channels == 1 || data_.channels == 3 : data_.channels == lambdas,
          "one channel, three, or one a wavelength");
  for (std::size_t k = 0; k < lambdas; ++k)
    require(std::isfinite(data_.lambda_nm[k]) && data_.lambda_nm[k] > (k > 0 ? data_.lambda_nm[k - 1] : 0),
            "increasing wavelengths");

  // angles
  require_finite(data_.phi_i, -std::numeric_limits<float>::max(), "phi_i");
  require_finite(data_.theta_i, 0, "theta_i");
  require_increasing(data_.phi_i, "phi_i");
  require_increasing(data_.theta_i, "theta_i");
  require(static_cast<double>(data_.theta_i.back()) < kHalfPi + 1e-3, "theta_i up to pi/2");

  // tables
  const std::size_t slices = data_.phi_i.size() * data_.theta_i.size();
  require_grid(data_.ndf, 1, "ndf");
  require_grid(data_.sigma, 1, "sigma");
  require_grid(data_.vndf, slices, "vndf");
  require_grid(data_.spectra, slices * data_.channels, "spectra");
  require_grid(data_.luminance, slices, "luminance");
  require_finite(data_.ndf.values, 0, "ndf");
  require_finite(data_.sigma.values, 0, "sigma");
  require_finite(data_.spectra.values, -std::numeric_limits<float>::max(), "spectra");
  require_finite(data_.luminance.values, -std::numeric_limits<float>::max(), "luminance");

  set_reduction();
  warp_ = ConditionalWarp2(data_.vndf.width, data_.vndf.height, data_.vndf.values);

  // A density has no negative values, and a dark slice is drawn from evenly.
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
  // The range of phi_i fits once, twice or four times in the circle.
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

/// Returns the slices next to an incident direction: two in theta_i, and for an anisotropic table also two in phi_i.
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
  // phi_i may start anywhere, so phi is moved into the turn that begins at the first one.
  phi -= kTwoPi * std::floor((phi - first) / kTwoPi);
  const auto [p, p_weight] = locate(data_.phi_i, phi);
  if (phi <= last) {
    add(p, 1 - p_weight);
    add(p + 1, p_weight);
    return mix;
  }
  // Beyond the last phi_i the circle closes. For a half or a quarter circle, only rounding leads here.
  const double gap = first + kTwoPi - last, beyond = gap > 0 ? std::min((phi - last) / gap, 1.0) : 0;
  const double to_first = reduction_ == 1 ? beyond : std::round(beyond);
  add(static_cast<std::uint32_t>(data_.phi_i.size() - 1), 1 - to_first);
  add(0, to_first);
  return mix;
}

/// The symmetry that takes a direction into the part of the circle that phi_i covers: nothing, a turn by pi or
/// a reflection in one of the mirror planes, all of which change signs only. It is its own inverse.
struct RglTable::Symmetry {
  double x = 1, y = 1;  // +1 or -1

  Vec3 operator()(Vec3 w) const noexcept { return {x * w.x, y * w.y, w.z}; }
};

RglTable::Symmetry RglTable::symmetry_of(Vec3 wi) const noexcept {
  // For half a circle, wi lies beyond it where it is clockwise from the first phi_i: it is turned by pi.
  if (reduction_ == 2 && wi.y * cos_first_ - wi.x * sin_first_ < 0) return {-1, -1};
  // For a quarter, wi is reflected into the quadrant that is stored.
  if (reduction_ == 4) return {wi.x * sign_x_ < 0 ? -1.0 : 1.0, wi.y * sign_y_ < 0 ? -1.0 : 1.0};
  return {};
}

/// The places of a pair of directions in the tables.
struct RglTable::TablePlaces {
  double theta_i, phi_i;  // of wi, for sigma
  Point2 half;            // of the half vector, in the squares of ndf and vndf
  Point2 sample;          // in the square of spectra and luminance
  SliceMix mix;           // the slices of the conditioned tables
};

RglTable::TablePlaces RglTable::places_of(Vec3 wi, Vec3 wo) const noexcept {
  // Both directions are taken into the part of the circle that is stored.
  const Symmetry symmetry = symmetry_of(wi);
  wi = symmetry(wi);
  const Vec3 h = wi + symmetry(wo);  // its length does not matter

  // The incident direction and the half vector become spherical angles.
  TablePlaces places{.theta_i = polar_angle(wi), .phi_i = 0};
  const double theta_h = polar_angle(h);
  double phi_h = 0;
  if (isotropic()) {
    // phi_h is measured from wi, by their cross and dot product in the plane.
    const Vec3 from = is_pole(wi) ? Vec3{1, 0, 0} : wi;
    phi_h = is_pole(h) ? 0 : std::atan2(from.x * h.y - from.y * h.x, from.x * h.x + from.y * h.y);
  } else {
    places.phi_i = azimuth(wi);
    phi_h = azimuth(h);
  }

  // The angles of the half vector become a place in the unit square [Dupuy 2018, sec. 4].
  places.half = rgl_square(theta_h, phi_h);

  // Inverting the warp by visible normals gives the place in the square of samples, where spectra are stored.
  places.mix = mix_at(places.phi_i, places.theta_i);
  places.sample = warp_.invert(places.half, places.mix);
  return places;
}

bool RglTable::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool RglTable::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  assert(f.size() == data_.channels);
  std::fill(f.begin(), f.end(), 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return true;
  const auto [theta_i, phi_i, half, sample, mix] = places_of(wi, wo);

  // The stored values were multiplied by cos(theta_o) and 4 sigma / ndf [Dupuy 2018, sec. 4]: the scale divides them
  // out.
  double scale = 1 / std::max(wo.z, kMinCosine);
  if (data_.jacobian)
    scale *= rgl_lookup(data_.ndf, half) /
             (4 * std::max(rgl_lookup(data_.sigma, rgl_square(theta_i, phi_i)), kMinSigma));

  // Spectra are interpolated bilinearly in the square and mixed over the slices.
  const auto channels = data_.channels;
  const auto width = static_cast<std::size_t>(data_.spectra.width);
  const std::size_t slice_size = width * static_cast<std::size_t>(data_.spectra.height);
  const GridCell at(sample, data_.spectra.width, data_.spectra.height);
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
  // The slices of wi are found in the part of the circle that is stored.
  const Symmetry symmetry = symmetry_of(wi);
  const Vec3 w = symmetry(wi);
  const double phi_i = azimuth(w);
  const SliceMix mix = mix_at(phi_i, polar_angle(w));

  // The uniform point is warped by luminance, then by visible normals, which gives the half vector.
  const Point2 sample = luminance_warp_.warp(u, mix), half = warp_.warp(sample, mix);
  const double phi_h = rgl_phi(half.y);
  const Vec3 h = spherical_direction(rgl_theta(half.x), isotropic() ? phi_h + phi_i : phi_h);

  // wi is reflected about it. The density divides by dwo = 4 dot(wi, h) dh [Walter 2007, eq. 14].
  const double to_half = dot(w, h);
  const Vec3 wo = symmetry(2 * to_half * h - w);
  const double area = solid_angle_over_area(half) * 4 * to_half;
  if (!(area > 0 && wo.z > 0)) return {wo, 0};
  return {wo, luminance_warp_.pdf(sample, mix) * warp_.pdf(half, mix) / area};
}

double RglTable::pdf_wo(Vec3 wi, Vec3 wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return 0;
  const auto [theta_i, phi_i, half, sample, mix] = places_of(wi, wo);
  // The density in the square becomes one per solid angle of wo.
  const double area = solid_angle_over_area(half) * 2 * length(wi + wo);  // 4 dot(wi, h) = 2 |wi + wo|
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
  const Vec3 h = spherical_direction(rgl_theta(half.x), rgl_phi(half.y));
  return {wi, normalize(2 * dot(wi, h) * h - wi)};
}

}  // namespace burnish
