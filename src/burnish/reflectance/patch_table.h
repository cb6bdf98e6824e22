// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A ring of equal patches of the hemisphere; patch k is centred 2 pi k / count from the azimuth of patch 0.
struct PatchRing {
  double theta_low = 0, theta_high = 0;  ///< radians
  std::size_t count = 1;
  std::size_t first = 0;  ///< index of its patch 0 in the basis

  friend bool operator==(const PatchRing&, const PatchRing&) = default;
};

/// A hemisphere cut into rings of patches, counted from the normal outwards.
struct PatchBasis {
  std::vector<PatchRing> rings;
  double first_azimuth = 0;  ///< of patch 0 of every ring, radians in [0, 2 pi)

  std::size_t size() const noexcept { return rings.empty() ? 0 : rings.back().first + rings.back().count; }
  /// The patch that a direction lies in; the outermost ring has what lies beyond.
  std::size_t patch_of(Vec3 w) const noexcept;
  /// The centre of a single patch at the normal is the normal.
  Vec3 centre(std::size_t patch) const noexcept;
  /// Integral of the cosine over a patch, sr; their sum is pi for a full hemisphere.
  double projected_solid_angle(std::size_t patch) const noexcept;

  friend bool operator==(const PatchBasis&, const PatchBasis&) = default;
};

/// An anisotropic matrix of f_r averaged over pairs of patches, as window systems are measured.
struct PatchTable {
  PatchBasis incident, outgoing;
  std::vector<float> values;  ///< [outgoing][incident][channel], 1/sr
  std::size_t channel_count = 1;

  std::size_t channels() const noexcept { return channel_count; }
  bool isotropic() const noexcept { return false; }
  /// Constant over pairs of patches, as Radiance evaluates it: what a patch receives is reflected, no more and no
  /// less. Between patch centres a peak as narrow as a patch would have another energy.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  /// Returns the share of light from wi that leaves the table's side, exact: a sum over patches.
  double albedo(Vec3 wi, std::size_t channel = 0) const noexcept;
};

static_assert(HasRawValues<PatchTable>);

/// The 145 patches of the full Klems basis. Source: [Klems 1994].
PatchBasis klems_full_basis();

/// The 77 and 41 patches of the coarser bases, borders and counts as Radiance 6 answers with them.
PatchBasis klems_half_basis();
PatchBasis klems_quarter_basis();
/// The 73 patches that programs before it have for the half basis.
PatchBasis klems_older_half_basis();

}  // namespace burnish
