#pragma once

#include <array>
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
};

/// Four patch centres around a direction and their weights, which sum to 1.
struct PatchNeighbours {
  std::array<std::size_t, 4> index{};
  std::array<double, 4> weight{};
};

/// A hemisphere cut into rings of patches, counted from the normal outwards.
struct PatchBasis {
  std::vector<PatchRing> rings;
  double first_azimuth = 0;  ///< of patch 0 of every ring, radians in [0, 2 pi)

  std::size_t size() const noexcept { return rings.empty() ? 0 : rings.back().first + rings.back().count; }
  /// Linear in theta between ring centres and in azimuth around each; constant beyond the outermost centre.
  /// The centre of a single patch at the normal is the normal.
  PatchNeighbours neighbours(Vec3 w) const noexcept;
  Vec3 centre(std::size_t patch) const noexcept;
  /// Integral of the cosine over a patch, sr; their sum is pi for a full hemisphere.
  double projected_solid_angle(std::size_t patch) const noexcept;
};

/// An anisotropic matrix of f_r averaged over pairs of patches, as window systems are measured.
struct PatchTable {
  PatchBasis incident, outgoing;
  std::vector<float> values;  ///< [outgoing][incident], 1/sr, grey

  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return false; }
  /// Linear between patch centres in both directions, see PatchBasis::neighbours: continuous, unlike the
  /// patches.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(HasRawValues<PatchTable>);

/// The 145 patches of the full Klems basis. Source: [Klems 1994].
PatchBasis klems_full_basis();

}  // namespace burnish
