// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <burnish/book/material_book.h>
#include <burnish/source.h>

namespace burnish {

struct BookOptions {
  std::uint64_t bytes = 64 << 10;  ///< at most so many for what materials share, MaterialBook::shared_bytes
  std::size_t bytes_a_material = 64;  ///< at most so many weights, a byte each; half of them say how bright
  std::uint64_t seed = 1;             ///< of the pairs that are drawn from each material
};

/// A material at the nodes of a volume: all that a book needs to know of it.
struct BookMaterial {
  std::string name;
  std::vector<double>
      logs;  ///< ln(f + MaterialBook::kFloor) of each axis of colour at each node, [axis][node]
  std::vector<double>
      weights;  ///< of each node in pictures and other pairs; the same scale for all materials
};

/// The volume whose components are as many as the bytes a material allow and, together, at most as large as the
/// bytes that are shared: the finest of a few. Throws Error if not even the coarsest has room for one component of
/// an axis.
std::array<int, 3> book_sides(const BookOptions& options);

/// Draws pixels of lit spheres and pairs of all directions from a source (draw_training_set), made reciprocal, and
/// fits the logarithms of one volume to them, by linear least squares. Scattered samples are fitted as they are.
/// Throws Error where the source is anisotropic, has neither one channel (grey) nor three, or knows no directions.
BookMaterial book_material(const Source& source, const std::string& name, std::array<int, 3> sides,
                           std::uint64_t seed);

/// Principal components of the materials' logarithms, of each axis of colour on its own, each node as heavy as
/// pictures and pairs that are spread over all directions make it; components are rounded to bytes and the weights
/// found by least squares after that. There are as many components as the bytes allow, and at most one fewer than
/// materials. The same bits whatever the number of threads. Throws Error for fewer than three materials, or none of
/// that size.
MaterialBook make_book(std::array<int, 3> sides, const std::vector<BookMaterial>& materials,
                       const BookOptions& options);

/// The same shared part with other materials: each one's weights by least squares, nodes as heavy as this material
/// makes them whatever others are given, rounded and, where they are
/// further out than any of the library's were by half, clamped.
MaterialBook with_materials(const MaterialBook& book, const std::vector<BookMaterial>& materials);

}  // namespace burnish
