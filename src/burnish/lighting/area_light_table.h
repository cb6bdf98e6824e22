#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <burnish/lighting/transformed_cosine.h>
#include <burnish/math/rgb.h>
#include <burnish/math/vec3.h>

namespace burnish {

/// Which views a table holds:
/// - line: polar angles alone, of an isotropic BRDF that is its own mirror image;
/// - quarter: azimuths from the tangent to the bitangent, of a BRDF that is its own mirror image along both;
/// - full: all azimuths.
enum class AreaLightViews { line, quarter, full };

/// One lobe of a table: a transformed cosine and its height for every view.
struct AreaLobe {
  /// Nine values a node, rows of the matrix from the frame of the mirrored view to the cosine (see AreaLightTable).
  std::vector<float> inverse;
  /// Three values a node, >= 0: what of a light all around the lobe would reflect, were none of it below the horizon.
  std::vector<float> amplitude;
};

/// A lobe for one view, in the local frame.
struct ShadedLobe {
  TransformedCosine shape;
  Rgb amplitude;
};

/// What a BRDF makes of area lights: f_r cos(theta_i) for every view as a sum of a cosine and of transformed cosines
/// [Heitz2016], found by fit_area_lights. Nodes are [azimuth][theta_o], theta_o faster. Node i of `thetas` stands at
/// tan(theta_o / 2) = i / (thetas - 1); azimuths are evenly spaced in |y| / (|x| + |y|), both ends of a quarter included,
/// of `full` in four such quarters, the last node the first again. The frame of the mirrored view has y at right angles
/// to view and normal, and z along the view's mirror direction.
struct AreaLightTable {
  AreaLightViews views = AreaLightViews::line;
  std::size_t thetas = 0, azimuths = 1;  ///< thetas >= 2; azimuths 1 for a line
  std::vector<float> cosine;             ///< three values a node, >= 0: the plain cosine's height
  std::vector<AreaLobe> lobes;           ///< kMaxLobes at most

  static constexpr std::size_t kMaxLobes = 3;

  std::size_t nodes() const noexcept { return thetas * azimuths; }
  /// Bytes of a lobe's tables in half precision: eight values a node of a line, twelve of others.
  std::size_t lobe_bytes() const noexcept { return 2 * nodes() * (views == AreaLightViews::line ? 8 : 12); }
  /// Bytes of all tables in half precision.
  std::size_t bytes() const noexcept { return lobes.size() * lobe_bytes() + 6 * nodes(); }
};

/// The lobes of one view: the cosine first.
struct ShadedLobes {
  std::array<ShadedLobe, AreaLightTable::kMaxLobes + 1> lobes;
  std::size_t count = 0;

  std::span<const ShadedLobe> all() const noexcept { return std::span(lobes).first(count); }
};

/// Linear between nodes, for a unit vector wo of the local frame above the horizon.
ShadedLobes shaded_lobes(const AreaLightTable& table, Vec3 wo) noexcept;

/// f_r cos(theta_i) as the table has it, 1/sr; zero below the horizon.
Rgb reflected_density(const AreaLightTable& table, Vec3 wi, Vec3 wo) noexcept;

/// The light reflected towards wo of a light all around of radiance 1.
Rgb albedo(const AreaLightTable& table, Vec3 wo) noexcept;

/// The radiance reflected towards wo of a polygon of radiance 1 that shines to both sides; corners in order, relative to
/// the point that is lit, of its local frame. Zero where wo is not above the horizon.
Rgb reflected(const AreaLightTable& table, std::span<const Vec3> polygon, Vec3 wo);

}  // namespace burnish
