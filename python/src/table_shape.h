// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/factors/table.h>

namespace burnish::python {

/// Returns (height, width, channels), and for a volume its depth before them.
inline std::vector<std::size_t> array_shape(const Table& table) {
  std::vector<std::size_t> shape;
  if (table.layout.shape == TableShape::volume) shape.push_back(static_cast<std::size_t>(table.layout.depth));
  for (const int side : {table.layout.height, table.layout.width})
    shape.push_back(static_cast<std::size_t>(side));
  shape.push_back(table.channels);
  return shape;
}

}  // namespace burnish::python
