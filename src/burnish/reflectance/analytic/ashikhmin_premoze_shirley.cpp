// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/math/quadrature.h>
#include <burnish/reflectance/analytic/ashikhmin_premoze_shirley.h>

namespace burnish {

namespace {

// With the mean of the normals, m, sigma(w) = (S(w) + w·m) / 2, where S(w) is the integral of D(h) |w·h|: a
// norm, whose square is smooth in w (for GGX a quadratic form), and so what the table holds.
// Rows run from grazing to normal, spaced by u = sqrt(1 - theta / (pi/2)): S bends within alpha of the
// horizon. One row beyond either end serves the cubic.
constexpr int kRows = 32;
constexpr int kColumns = 64;

Vec3 direction_of_row(int row, double phi) noexcept {
  const double u = static_cast<double>(row) / kRows;
  return spherical_direction(kHalfPi * (1 - u * u), phi);
}

/// Microfacets standing for the distribution: normals with the area each stands for.
struct Facets {
  std::vector<Vec3> normal;
  std::vector<double> area;
};

Facets sample_facets(const std::function<double(Vec3)>& density) {
  // Polar angles theta = (pi/2) v², dense at the normal, where densities peak.
  constexpr int kPolar = 64, kAzimuth = 256;
  const GaussLegendre<kPolar>& rule = gauss_legendre<kPolar>();
  Facets facets;
  for (std::size_t i = 0; i < kPolar; ++i) {
    const double v = 0.5 * (1 + rule.node[i]), theta = kHalfPi * v * v;
    const double solid_angle = std::sin(theta) * kPi * v * 0.5 * rule.weight[i] * (kTwoPi / kAzimuth);
    for (int j = 0; j < kAzimuth; ++j) {
      const Vec3 h = spherical_direction(theta, kTwoPi * (j + 0.5) / kAzimuth);
      const double d = density(h);
      if (!(d >= 0 && std::isfinite(d)))
        throw Error("microfacet distribution: expected finite densities >= 0");
      if (d == 0) continue;
      facets.normal.push_back(h);
      facets.area.push_back(d * solid_angle);
    }
  }
  return facets;
}

/// Weights of the cubic through four equidistant values (Catmull-Rom), at t in [0, 1] between the middle two.
std::array<double, 4> cubic_weights(double t) noexcept {
  const double t2 = t * t, t3 = t2 * t;
  return {0.5 * (-t + 2 * t2 - t3), 0.5 * (2 - 5 * t2 + 3 * t3), 0.5 * (t + 4 * t2 - 3 * t3),
          0.5 * (t3 - t2)};
}

}  // namespace

ProjectedAreaTable::ProjectedAreaTable(const std::function<double(Vec3)>& density, bool isotropic)
    : squares_(static_cast<std::size_t>((kRows + 3) * kColumns)) {
  const Facets facets = sample_facets(density);
  for (std::size_t k = 0; k < facets.normal.size(); ++k)
    mean_normal_ = mean_normal_ + facets.area[k] * facets.normal[k];
  if (!(mean_normal_.z > 0)) throw Error("microfacet distribution: expected a density above 0 somewhere");
  density_scale_ = 1 / mean_normal_.z;
  mean_normal_ = isotropic ? Vec3{0, 0, 1} : density_scale_ * mean_normal_;

  for_each_chunk(kRows + 3, 1, [&](std::size_t row, std::size_t, std::size_t) {
    double* const squares = &squares_[row * kColumns];
    double mean = 0;
    for (int column = 0; column < kColumns; ++column) {
      const Vec3 w = direction_of_row(static_cast<int>(row) - 1, kTwoPi * column / kColumns);
      double sum = 0;
      for (std::size_t k = 0; k < facets.normal.size(); ++k)
        sum += facets.area[k] * std::abs(dot(w, facets.normal[k]));
      squares[column] = (sum * density_scale_) * (sum * density_scale_);
      mean += squares[column] / kColumns;
    }
    if (isotropic) std::fill(squares, squares + kColumns, mean);
  });
}

double ProjectedAreaTable::operator()(Vec3 w) const noexcept {
  const double elevation = std::atan2(w.z, std::hypot(w.x, w.y));
  const double row = kRows * std::sqrt(elevation / kHalfPi), column = phi_of(w) * (kColumns / kTwoPi);
  const int row0 = std::min(static_cast<int>(row), kRows - 1), column0 = static_cast<int>(column);
  const std::array<double, 4> row_weight = cubic_weights(row - row0),
                              column_weight = cubic_weights(column - column0);
  double square = 0;
  for (int i = 0; i < 4; ++i) {
    const double* const squares = &squares_[static_cast<std::size_t>((row0 + i) * kColumns)];
    double sum = 0;
    for (int j = 0; j < 4; ++j)
      sum += column_weight[static_cast<std::size_t>(j)] * squares[(column0 + j + kColumns - 1) % kColumns];
    square += row_weight[static_cast<std::size_t>(i)] * sum;
  }
  return std::max(0.5 * (std::sqrt(std::max(square, 0.0)) + dot(w, mean_normal_)), w.z);
}

double masking_correlation(Vec3 wi, Vec3 wo, double width) noexcept {
  if (width <= 0) return 0;
  const double angle = std::atan2(std::abs(wi.x * wo.y - wi.y * wo.x), wi.x * wo.x + wi.y * wo.y);
  return std::exp(-0.5 * (angle / width) * (angle / width));
}

}  // namespace burnish
