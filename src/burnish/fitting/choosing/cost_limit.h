// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace burnish {

/// The largest cost of a model: bytes as FactoredBrdf::bytes counts them, reads as fetch_count does.
struct CostLimit {
  std::size_t bytes = 16'384, texel_bytes = 4;
  int fetches = 2;  ///< >= 1
};

}  // namespace burnish
