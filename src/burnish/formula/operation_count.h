#pragma once

#include <burnish/formula/expression.h>

namespace burnish {

/// What computing values takes, counted from their formula: floating-point operations a component. Changes of
/// sign, integers and conversions are not counted.
struct OperationCount {
  int multiplies = 0, adds = 0, compares = 0;  ///< compares: minima, maxima, floors and selects
  int divisions = 0, roots = 0, transcendentals = 0, fetches = 0;

  OperationCount& operator+=(const OperationCount& other) noexcept;
  friend bool operator==(const OperationCount&, const OperationCount&) = default;
};

/// Of one operation whose value is of this type.
OperationCount count_of(Op op, ValueType type) noexcept;

}  // namespace burnish
