// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A dense isotropic table over (theta_h, theta_d, phi_d), the grid of the MERL database. Entry (h, d, p) is
/// the value at the centre of its cell:
///   theta_h = ((h + 1/2) / theta_h_count)^2 pi/2, theta_d = (d + 1/2) / theta_d_count pi/2,
///   phi_d = (p + 1/2) / phi_d_count times pi, or times 2 pi where full_circle.
/// Half a circle of phi_d suffices for a reciprocal material: exchanging the directions adds pi to phi_d.
struct HalfDiffTable {
  int theta_h_count = 0, theta_d_count = 0, phi_d_count = 0;
  bool full_circle = false;  ///< phi_d over [0, 2 pi) instead of [0, pi)
  std::size_t channel_count = 3;
  std::vector<float> values;  ///< [theta_h][theta_d][phi_d][channel], 1/sr; NaN in all channels marks a hole

  std::size_t channels() const noexcept { return channel_count; }
  bool isotropic() const noexcept { return true; }
  /// Trilinear in (sqrt theta_h, theta_d, phi_d), phi_d periodic, constant beyond the outermost centres.
  /// Holes have no weight, the others' weights are scaled to sum to 1; unknown where all eight neighbours are
  /// holes.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  std::size_t entry_count() const noexcept {
    return static_cast<std::size_t>(theta_h_count) * static_cast<std::size_t>(theta_d_count) *
           static_cast<std::size_t>(phi_d_count);
  }
  /// Index of an entry's first channel in `values`.
  std::size_t offset(int h, int d, int p) const noexcept;
  /// Angles of an entry's centre; phi_h is 0.
  HalfDiff centre(int h, int d, int p) const noexcept;
  /// True where both directions of the entry's centre lie above the horizon.
  bool above_horizon(int h, int d, int p) const noexcept;
};

/// The customary lookup of a MERL table, without interpolation: the value of the cell the directions fall
/// into.
struct NearestHalfDiff {
  const HalfDiffTable* table = nullptr;

  std::size_t channels() const noexcept { return table->channels(); }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(HasRawValues<HalfDiffTable> && Brdf<NearestHalfDiff>);

/// Samples an isotropic source at the centres of a table's cells, on all threads; entries below the horizon
/// and unknown ones become holes. Throws Error if the source is anisotropic or a count is below 1.
HalfDiffTable tabulate_half_diff(BrdfRef source, int theta_h_count, int theta_d_count, int phi_d_count,
                                 bool full_circle);

}  // namespace burnish
