// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/formula/expression.h>

namespace burnish {

/// The operations that computing values takes, counted from their formula: floating-point operations for each
/// component. Changes of sign, integers, conversions and the work of called functions are not counted.
struct OperationCount {
  int multiplies = 0, adds = 0, compares = 0;  ///< compares: minima, maxima, floors and selects
  int divisions = 0, roots = 0, transcendentals = 0, fetches = 0;

  OperationCount& operator+=(const OperationCount& other) noexcept;
  friend bool operator==(const OperationCount&, const OperationCount&) = default;
};

/// Returns the count of one operation whose value is of this type.
OperationCount count_of(Op op, ValueType type) noexcept;

}  // namespace burnish
