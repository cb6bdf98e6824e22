// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/conditional_warp.h>
#include <burnish/reflectance/sampling.h>

namespace burnish {

/// A grid that spans the unit square: values[height][width], or [phi_i][theta_i][height][width] of a
/// conditioned one. Columns run over u, rows over v.
struct RglGrid {
  int width = 0, height = 0;
  std::vector<float> values;
};

/// The contents of an RGL measurement. Directions enter the unit square as
///   u = sqrt(2 theta / pi),   v = (phi + pi) / (2 pi);
/// isotropic tables measure phi of the half vector from wi. [Dupuy 2018, sec. 4]
struct RglData {
  std::string description;
  std::vector<double> lambda_nm;  ///< of the channels; empty for linear Rec. 709 or grey
  std::size_t channels = 0;       ///< 1, 3 or lambda_nm.size()
  std::vector<float> phi_i;       ///< increasing radians; at most two: isotropic (the first is used)
  std::vector<float> theta_i;     ///< increasing radians in [0, pi/2]
  RglGrid ndf;                    ///< normal distribution, 1/sr, [height][width]
  RglGrid sigma;         ///< projected area of the microfacets seen from a direction, [height][width]
  RglGrid vndf;          ///< density of visible half vectors in (u, v), at any scale, conditioned
  RglGrid luminance;     ///< like spectra, grey: for those who draw directions
  RglGrid spectra;       ///< values over the warped square, conditioned, channel fastest
  bool jacobian = true;  ///< spectra are f_r cos(theta_o) 4 sigma / ndf, else f_r cos(theta_o)
  std::vector<std::uint8_t> valid;  ///< one bit a node of spectra, highest first; 0: filled in; may be empty
};

/// A reflectance in the adaptive parameterization of the RGL material database. The tables' first direction
/// is wi. Anisotropic tables whose phi_i cover half or a quarter of the circle are completed by rotation by
/// pi, or by the two mirror planes. Source: [Dupuy 2018].
class RglTable {
 public:
  /// Throws Error unless the sizes agree, every number is finite, ndf and sigma are >= 0, vndf is a density,
  /// angles increase within their domain and several phi_i cover the circle, a half or a quarter of it.
  explicit RglTable(RglData data);

  const RglData& data() const noexcept { return data_; }
  std::size_t channels() const noexcept { return data_.channels; }
  bool isotropic() const noexcept { return data_.phi_i.size() <= 2; }
  /// Returns how often the range of phi_i fits in the circle: 1, 2 or 4.
  int reduction() const noexcept { return reduction_; }

  /// f_r; see Brdf. The spectra are interpolated as they are stored and the result is cut at zero, as the
  /// database's own loader does. The cosine of wo that the table contains is divided out, with the cosine taken
  /// as at least 1e-6.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// The measurement's own way of drawing: the second direction for a given first one, wi, along the warps
  /// by luminance and visible normals that the file stores; u in [0, 1)^2. `wi` of the result is the drawn
  /// direction; it may lie below the horizon, where its density is lost. [Dupuy 2018, sec. 4.2]
  DrawnDirection sample_wo(Vec3 wi, Point2 u) const noexcept;
  /// Density per solid angle with which sample_wo(wi) draws wo, 1/sr; zero below the horizon.
  double pdf_wo(Vec3 wi, Vec3 wo) const noexcept;

  /// Directions of a node of spectra; wo may lie below the horizon.
  /// Precondition: indices below the sizes of phi_i, theta_i and spectra.
  DirectionPair node_directions(int phi, int theta, int row, int column) const noexcept;

 private:
  void set_reduction();
  SliceMix mix_at(double phi, double theta) const noexcept;
  struct Symmetry;
  Symmetry symmetry_of(Vec3 wi) const noexcept;
  struct TablePlaces;
  TablePlaces places_of(Vec3 wi, Vec3 wo) const noexcept;

  RglData data_;
  ConditionalWarp2 warp_, luminance_warp_;
  int reduction_ = 1;
  double sign_x_ = 0, sign_y_ = 0;        // reduction 4: signs of wi in the quadrant that is stored
  double cos_first_ = 0, sin_first_ = 0;  // reduction 2: the first phi_i
};

static_assert(HasRawValues<RglTable>);

/// sample_wo and pdf_wo as a DirectionSampler: the measurement taken with its directions exchanged, as it is
/// used where light is followed from the eye. Refers to the table.
struct RglSampler {
  const RglTable* table;

  DrawnDirection sample_wi(Vec3 wo, Point2 u) const noexcept { return table->sample_wo(wo, u); }
  double pdf(Vec3 wi, Vec3 wo) const noexcept { return table->pdf_wo(wo, wi); }
};

static_assert(DirectionSampler<RglSampler>);

/// The unit square of half vectors and incident directions; see RglData. theta in [0, pi/2], phi in [-pi, pi].
Point2 rgl_square(double theta, double phi) noexcept;
/// Its inverse: theta of a column's u in [0, 1] and phi of a row's v in [0, 1], radians.
constexpr double rgl_theta(double u) noexcept {
  return u * u * kHalfPi;
}
constexpr double rgl_phi(double v) noexcept {
  return v * kTwoPi - kPi;
}
/// Bilinear value of an unconditioned grid at p in [0, 1]^2.
double rgl_lookup(const RglGrid& grid, Point2 p) noexcept;

}  // namespace burnish
