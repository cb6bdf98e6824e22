// SPDX-License-Identifier: Apache-2.0
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

/// The views that a table holds:
/// - line: polar angles alone, of an isotropic BRDF that is its own mirror image;
/// - quarter: azimuths from the tangent to the bitangent, of a BRDF that is its own mirror image along both;
/// - full: all azimuths.
enum class AreaLightViews { line, quarter, full };

/// One lobe of a table: a transformed cosine and its height for every view.
struct AreaLobe {
  /// Nine values a node, rows of the matrix from the frame of the mirrored view to the cosine (see AreaLightTable).
  std::vector<float> inverse;
  /// Three values a node, >= 0. A uniform light of radiance 1 from all directions would reflect this much, if no part
  /// of the lobe were below the horizon.
  std::vector<float> amplitude;
};

/// A lobe for one view, in the local frame.
struct ShadedLobe {
  TransformedCosine shape;
  Rgb amplitude;
};

/// The reflection of area lights by a BRDF. For every view, f_r cos(theta_i) is the sum of a cosine and of
/// transformed cosines [Heitz2016], which fit_area_lights finds. Nodes are [azimuth][theta_o], theta_o faster. Node i
/// of `thetas` stands at tan(theta_o / 2) = i / (thetas - 1). Azimuths are evenly spaced in |y| / (|x| + |y|). A
/// quarter includes both ends; `full` has four quarters, and its last node is the first again. The frame of the
/// mirrored view has y at right angles to view and normal, and z along the view's mirror direction.
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

/// Interpolates linearly between nodes, for a unit vector wo of the local frame above the horizon.
ShadedLobes shaded_lobes(const AreaLightTable& table, Vec3 wo) noexcept;

/// Returns the table's f_r cos(theta_i), 1/sr; zero below the horizon.
Rgb reflected_density(const AreaLightTable& table, Vec3 wi, Vec3 wo) noexcept;

/// Returns the radiance reflected towards wo from light of radiance 1 from all directions.
Rgb albedo(const AreaLightTable& table, Vec3 wo) noexcept;

/// Returns the radiance reflected towards wo from a polygon of radiance 1 that shines to both sides. Corners are in
/// order, relative to the lit point, in its local frame. Zero if wo is not above the horizon.
Rgb reflected(const AreaLightTable& table, std::span<const Vec3> polygon, Vec3 wo);

}  // namespace burnish
