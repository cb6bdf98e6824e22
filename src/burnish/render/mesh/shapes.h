// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <burnish/render/mesh/mesh.h>

namespace burnish {

/// The built-in meshes, y up, centred on the origin, within the unit sphere. Tangents follow u, normals are
/// those of the exact surface. `columns` run along u, `rows` along v; vertices where u wraps are there twice.
enum class Shape { sphere, teapot, torus_knot, plane };

/// "sphere", "teapot", "torus-knot" or "plane"; nothing for other names.
std::optional<Shape> parse_shape(std::string_view name) noexcept;

/// Unit sphere, tangents around the y axis: (columns + 1) (rows + 1) vertices. Throws Error unless columns is
/// in [3, 8192] and rows in [2, 8192].
Mesh make_sphere(int columns, int rows);

/// The tube of radius 0.14 around the curve that winds three times about a circle while it goes around
/// twice; tangents along the curve. (columns + 1) (rows + 1) vertices. Throws Error unless both are in
/// [3, 8192].
Mesh make_torus_knot(int columns, int rows);

/// The teapot of render/mesh/teapot.h, every patch cut into `segments` by `segments`; tangents around the
/// vertical axis on body and lid, across handle and spout. 32 (segments + 1)^2 vertices. Throws Error unless
/// segments is in [1, 1024].
Mesh make_teapot(int segments);

/// A square that faces +z, its corners on the unit sphere, tangents along x: (cells + 1)^2 vertices. Throws Error unless
/// cells is in [1, 8192].
Mesh make_plane(int cells);

/// The shape with about `vertices` vertices (within a fifth from 1,000 up), nearly square cells. Throws Error
/// unless it is in [64, 2^24].
Mesh make_shape(Shape shape, int vertices);

}  // namespace burnish
