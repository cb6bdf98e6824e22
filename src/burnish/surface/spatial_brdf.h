// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/surface/surface_map.h>

namespace burnish {

/// The most lobes of a surface.
inline constexpr std::size_t kMaxSurfaceLobes = 16;

/// A surface's maps, all of one size.
struct SurfaceMaps {
  std::vector<SurfaceMap> weights;  ///< one a lobe, of one channel or as many as the BRDF has; >= 0
  /// x and y of the shading normal in the surface's frame, halves, x^2 + y^2 <= 1; z is the root of what is left.
  std::optional<SurfaceMap> normals;
  /// x and y of a vector in the surface's plane, halves, along which the lobes' tangent lies: it is what of it is at
  /// right angles to the normal. (1, 0) where there is no map.
  std::optional<SurfaceMap> tangents;

  friend bool operator==(const SurfaceMaps&, const SurfaceMaps&) = default;
};

/// A lobe as bumps that a mip level no longer shows make it look: a copy of another, wider one.
struct WidenedLobe {
  std::size_t lobe = 0;  ///< which it is a copy of
  double variance = 0;   ///< of the bumps' normals, along each axis; > 0

  friend bool operator==(const WidenedLobe&, const WidenedLobe&) = default;
};

/// Three unit vectors at right angles to each other, tangent x bitangent = normal.
struct ShadingFrame {
  Vec3 tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};

  Vec3 local(Vec3 w) const noexcept { return {dot(tangent, w), dot(bitangent, w), dot(normal, w)}; }
};

/// The frame about a normal, z > 0, whose tangent is along `tangent` as far as the normal allows. Both are unit
/// vectors, not parallel.
ShadingFrame frame_about(Vec3 normal, Vec3 tangent) noexcept;

/// A factored BRDF whose lobes' scales are maps: f(u, v, wi, wo) = sum over lobes of weight(u, v) times the lobe's
/// own value at (wi, wo) turned into the texel's frame. Linear in the weights, so that their mip levels are those of
/// the surface where the frame is the same, and reciprocal as the lobes are. One or three channels.
class SpatialBrdf {
 public:
  /// Throws Error unless there are 1 to kMaxSurfaceLobes lobes of one or three channels, and a weight map for each,
  /// of one channel or the lobes'. Every map must have the same size. Weights must not be negative; normals and
  /// tangents must be two channels of halves within their ranges. The last lobes may be widened ones, see
  /// with_widened_lobes: no maps are given for them, but normals have to be. Their weights are made: some in mip
  /// levels alone, and their lobes have so much less there. The weights of a lobe stand together, by rising variance.
  SpatialBrdf(FactoredBrdf lobes, SurfaceMaps maps, std::vector<WidenedLobe> widened = {});

  std::size_t channels() const noexcept { return lobes_.channels(); }
  int width() const noexcept { return maps_.weights.front().width(); }
  int height() const noexcept { return maps_.weights.front().height(); }
  const FactoredBrdf& lobes() const noexcept { return lobes_; }
  /// Weights of all lobes, the widened ones' too.
  const SurfaceMaps& maps() const noexcept { return maps_; }
  /// Returns the widened lobes, which are the last ones.
  std::span<const WidenedLobe> widened() const noexcept { return widened_; }
  /// Returns how many lobes have weights of their own: the first ones.
  std::size_t own_lobes() const noexcept { return lobes_.lobes().size() - widened_.size(); }
  /// These, with the tables that they look up.
  FactoredBrdf own_model() const;

  /// A lobe's weight, one a channel: those of a grey map three times the same.
  using Weight = SurfaceMap::Value;
  Weight weight(std::size_t lobe, double u, double v, double lod = 0) const noexcept;
  ShadingFrame frame(double u, double v, double lod = 0) const noexcept;
  /// The same at a place of the maps.
  Weight weight(std::size_t lobe, const SurfaceMap::Place& at) const noexcept;
  ShadingFrame frame(const SurfaceMap::Place& at) const noexcept;
  /// Returns the place of (u, v) and a level of detail in any of the maps.
  SurfaceMap::Place map_place(double u, double v, double lod = 0) const noexcept {
    return maps_.weights.front().place(u, v, lod);
  }

  /// The data of a place that is the same for all directions.
  struct Place {
    ShadingFrame frame;
    std::array<Weight, kMaxSurfaceLobes> weights;  ///< the first of them, one a lobe
  };
  Place place(double u, double v, double lod = 0) const noexcept;
  /// f_r in 1/sr at a place, of unit vectors of its own frame; zero below the horizon. f has channels() entries.
  void eval(const Place& place, Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// f_r in 1/sr at a place of the surface and a level of detail, see SurfaceMap::sample; the definition. Unit vectors
  /// of the surface's frame; zero where either is below the shading horizon. f has channels() entries.
  void eval(double u, double v, double lod, Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// The uniform model of that place, in its own frame: the lobes' scales times their weights.
  FactoredBrdf at(double u, double v, double lod = 0) const;
  /// Returns the BRDF of one texel, unfiltered, with the own lobes. Throws Error if there is no such texel.
  FactoredBrdf texel(int x, int y) const;

  /// Bytes of the weights, and of normals and tangents, a texel of level 0, as a file has them.
  std::size_t weight_bytes() const noexcept;
  std::size_t frame_bytes() const noexcept;
  /// All maps' bytes of level 0 plus those of the lobes.
  std::size_t bytes() const noexcept;

  friend bool operator==(const SpatialBrdf& a, const SpatialBrdf& b) {
    return a.lobes_ == b.lobes_ && a.maps_ == b.maps_ && a.widened_ == b.widened_;
  }

 private:
  /// The first lobes, their scales times their weights at a place.
  std::vector<Lobe> scaled_lobes(std::size_t count, const SurfaceMap::Place& at) const;

  FactoredBrdf lobes_;
  SurfaceMaps maps_;
  std::vector<WidenedLobe> widened_;
  std::vector<FactoredBrdf> apart_;  // one lobe each
};

/// One lobe of a model alone, with the tables that it looks up.
FactoredBrdf lobe_alone(const FactoredBrdf& brdf, std::size_t lobe);

/// The largest share of light that texels reflect, see directional_albedo.
struct SurfaceAlbedo {
  double largest = 0;         ///< over texels, channels and directions of light
  int x = 0, y = 0;           ///< of the texel where
  double theta_i = 0;         ///< and the light's angle to its normal, radians
  std::size_t above_one = 0;  ///< texels that reflect more than they get from some of these directions
  double mean = 0;            ///< over texels, channels and directions
};

/// Returns the albedo of every texel of level 0 under light from 0 to 75 degrees, from two sides for lobes that are
/// not isotropic. The albedo is linear in the weights, so it takes the lobes' albedos once and a sum for each texel.
/// Deterministic.
SurfaceAlbedo surface_albedo(const SpatialBrdf& surface);

}  // namespace burnish
