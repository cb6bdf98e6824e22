// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace burnish {

/// A point of the unit square.
struct Point2 {
  double x = 0, y = 0;
};

}  // namespace burnish
