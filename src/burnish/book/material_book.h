// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// The part of one axis of colour that a library of materials shares. Logarithms at the nodes of one volume are the
/// mean plus a sum of components, each with a weight of the material's own.
struct BookAxis {
  std::vector<float> mean;              ///< one a node, halves
  std::vector<std::int8_t> components;  ///< [component][node]
  std::vector<float> scales;            ///< one a component, > 0: what its numbers are multiplied by
  std::vector<float> steps;             ///< one a component, > 0: what a stored weight is multiplied by
  std::vector<float> deviations;        ///< one a component, > 0: standard deviation of the library's weights
  float residual = 0;                   ///< > 0: standard deviation of what the components leave of a node

  std::size_t component_count() const noexcept { return scales.size(); }

  friend bool operator==(const BookAxis&, const BookAxis&) = default;
};

/// A book: isotropic materials of three channels as a few bytes each beside what they share. With u the axes of colour
/// (kBookAxes), theta_h, theta_d and phi_d of a pair of directions,
///
///   ln(f + floor) = sum over axes u (mean_u + sum_k w_uk g_uk)(theta_h, theta_d, phi_d),
///
/// a product of powers of shared tables. Whatever the weights are, f is positive, reciprocal and its own mirror image,
/// and one volume holds it: a material of a book is an ordinary model, that volume times a line of theta_h, which takes
/// the range of a highlight that a texel has no bits for. Two fetches.
class MaterialBook {
 public:
  static constexpr std::size_t kChannels = 3, kAxes = 3;
  /// The floor, 1/sr: that of the figure `relative`, below which errors do not count.
  static constexpr double kFloor = 1e-3;
  static constexpr std::size_t kMaxComponents = 256, kMaxMaterials = 1 << 20;

  struct Material {
    std::string name;
    std::vector<std::int8_t> weights;  ///< of each axis' components in turn

    friend bool operator==(const Material&, const Material&) = default;
  };

  /// An empty book.
  MaterialBook() = default;
  /// Throws Error if a size, a number (finite, in the range said above), a name (not empty, no two alike) or the
  /// number of a material's weights does not fit. `sides`: nodes along theta_h, theta_d and phi_d.
  MaterialBook(std::array<int, 3> sides, std::array<BookAxis, kAxes> axes, std::vector<Material> materials);

  /// Returns the layout of the volume: theta_h with a root warp, theta_d and phi_d even in tan(theta / 2).
  const TableLayout& layout() const noexcept { return layout_; }
  std::size_t node_count() const noexcept { return layout_.node_count(); }
  const std::array<BookAxis, kAxes>& axes() const noexcept { return axes_; }
  std::span<const Material> materials() const noexcept { return materials_; }
  std::optional<std::size_t> find(std::string_view name) const noexcept;

  /// Bytes that all materials share: means, components and the numbers of both.
  std::size_t shared_bytes() const noexcept;
  /// Bytes of the weights of one material.
  std::size_t bytes_a_material() const noexcept;

  /// The weights of material i, one a component, as they are multiplied.
  std::array<std::vector<double>, kAxes> weights(std::size_t i) const;
  /// Logarithms ln(f + kFloor) at the nodes, [node][channel]. Precondition: as many weights as components.
  std::vector<double> logs(const std::array<std::vector<double>, kAxes>& weights) const;
  /// Material i as a model, rgb9e5 unless told otherwise.
  FactoredBrdf brdf(std::size_t i, TableFormat format = TableFormat::rgb9e5) const;

  friend bool operator==(const MaterialBook&, const MaterialBook&) = default;

 private:
  TableLayout layout_;
  std::array<BookAxis, kAxes> axes_;
  std::vector<Material> materials_;
};

/// The axes of colour, orthonormal, [axis][channel]: brightness, red against blue, green against both.
extern const std::array<std::array<double, 3>, MaterialBook::kAxes> kBookAxes;

/// The volume's layout for a number of nodes along each axis.
TableLayout book_layout(std::array<int, 3> sides);

/// The volume's use in the models that brdf_of_logs makes: over theta_h, theta_d and phi_d.
FactorUse book_use();

/// A node of a volume and its share of a lookup.
struct NodeShare {
  std::size_t node = 0;
  double share = 0;
};

/// The nodes of a book's volume that a pair of directions above the horizon looks up; the shares' sum is 1.
std::array<NodeShare, 8> book_nodes(const TableLayout& layout, const DirectionPair& pair) noexcept;

/// The model "z(h) g(h,d,azimuth)" of logarithms ln(f + MaterialBook::kFloor) at a volume's nodes, [node][channel]:
/// positive, whatever they are. Its volume has a node more between any two along theta_d and phi_d, since tables are
/// linear in f. Throws Error as from_log_tables does.
FactoredBrdf brdf_of_logs(const TableLayout& coarse, std::span<const double> coarse_logs, TableFormat format);

}  // namespace burnish
