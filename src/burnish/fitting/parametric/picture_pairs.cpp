// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/fitting/parametric/picture_pairs.h>
#include <burnish/fitting/refinement/picture_loss.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {

namespace {

// Within this distance of the highlight's centre, of the sphere's radius, places crowd at it; elsewhere at the limb.
constexpr double kNear = 0.35;
constexpr double kCrowding = 2.5;  // radii near the highlight are this power of equal steps

/// Rings, and places on one.
struct Rings {
  int rings, places;
};
constexpr Rings kHighlight{20, 8}, kSphere{24, 16};  // half of each sphere
constexpr Rings kWholeHighlight{16, 16}, kWholeSphere{20, 24};
constexpr int kRingsAlone = 160;  // lit along the view, all around the same

double shown_value(double exposure, double f, double cosine) noexcept {
  return std::pow(std::max(exposure * f * cosine, 0.0), PictureLoss::kInverseGamma);
}

/// Adds the place (x, y) of a sphere of radius 1 and its area.
void append_place(Vec3 light, double x, double y, double area, PicturePairs& out) {
  const double z2 = 1 - x * x - y * y;
  if (z2 <= 0) return;
  const Vec3 n{x, y, std::sqrt(z2)}, wi = sphere_local(n, light);
  if (wi.z <= 0) return;
  const double frames = 4 * static_cast<double>(kSphereLights.size());
  out.pairs.push_back({wi, sphere_local(n, {0, 0, 1})});
  out.weights.push_back(area / frames);
}

/// The sphere lit along the view: a radius, crowding at the centre and at the limb.
void append_radius(PicturePairs& out) {
  for (int i = 0; i < kRingsAlone; ++i) {
    const auto radius = [](double u) { return std::sin(kHalfPi * std::pow(u, 1.5)); };
    const double inner = radius(static_cast<double>(i) / kRingsAlone),
                 outer = radius((i + 1.0) / kRingsAlone);
    append_place({0, 0, 1}, radius((i + 0.5) / kRingsAlone), 0, kPi * (outer * outer - inner * inner), out);
  }
}

/// One lit sphere, or the half of it whose mirror image the other is: midpoints of rings about the highlight, and about
/// the centre beyond it.
void append_sphere(double light_angle, bool whole, PicturePairs& out) {
  const Vec3 light{std::sin(light_angle), 0, std::cos(light_angle)};
  const double centre = std::sin(light_angle / 2), turn = whole ? kTwoPi : kPi, copies = whole ? 1 : 2;
  const auto for_rings = [&](Rings how, const auto& radius, const auto& add) {
    for (int i = 0; i < how.rings; ++i) {
      const double inner = radius(static_cast<double>(i) / how.rings), outer = radius((i + 1.0) / how.rings);
      const double middle = radius((i + 0.5) / how.rings);
      const double area = copies * turn / how.places * (outer * outer - inner * inner) / 2;
      for (int j = 0; j < how.places; ++j) {
        const double phi = turn * (j + 0.5) / how.places;
        add(middle * std::cos(phi), middle * std::sin(phi), area);
      }
    }
  };
  for_rings(
      whole ? kWholeHighlight : kHighlight, [](double u) { return kNear * std::pow(u, kCrowding); },
      [&](double x, double y, double area) { append_place(light, centre + x, y, area, out); });
  for_rings(
      whole ? kWholeSphere : kSphere, [](double u) { return std::sin(kHalfPi * u); },
      [&](double x, double y, double area) {
        if (std::hypot(x - centre, y) > kNear) append_place(light, x, y, area, out);
      });
}

}  // namespace

std::vector<double> PicturePairs::shown_of(BrdfRef brdf) const {
  std::vector<double> all(3 * pairs.size());
  std::array<double, 3> f;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    brdf.eval(pairs[i].wi, pairs[i].wo, f);
    for (std::size_t c = 0; c < 3; ++c) all[3 * i + c] = shown_value(exposure, f[c], pairs[i].wi.z);
  }
  return all;
}

bool PicturePairs::grey() const noexcept {
  for (std::size_t i = 0; i < values.size(); i += 3)
    if (values[i] != values[i + 1] || values[i] != values[i + 2]) return false;
  return true;
}

double PicturePairs::mean_squared_error(std::span<const double> other, double dim) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double difference = std::min(1.0, dim * shown[i]) - std::min(1.0, dim * other[i]);
    sum += weights[i / 3] / 3 * difference * difference;
  }
  return sum;
}

PicturePairs picture_pairs(BrdfRef source, double exposure) {
  PicturePairs all;
  for (const double light : kSphereLights)
    if (source.isotropic() && light == 0)
      append_radius(all);
    else
      append_sphere(light, !source.isotropic(), all);
  // what the source knows, grey standing for every channel
  PicturePairs result;
  result.exposure = exposure;
  const std::size_t channels = source.channels();
  std::array<double, 3> f;
  for (std::size_t i = 0; i < all.pairs.size(); ++i) {
    const DirectionPair& pair = all.pairs[i];
    if (!source.eval(pair.wi, pair.wo, std::span(f).first(channels))) continue;
    result.pairs.push_back(pair);
    result.weights.push_back(all.weights[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      result.values.push_back(f[channels == 1 ? 0 : c]);
      result.shown.push_back(shown_value(exposure, result.values.back(), pair.wi.z));
    }
  }
  return result;
}

}  // namespace burnish
