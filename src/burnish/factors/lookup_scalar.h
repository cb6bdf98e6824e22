// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/parameterization/projection_scalar.h>

/// The formulas of lookup-inl.h for double: the definition.
namespace burnish::definition {

inline double whole(double x) noexcept {
  return static_cast<int>(x);
}

#define FORMULA_INLINE inline
#include <burnish/factors/lookup-inl.h>
#undef FORMULA_INLINE

}  // namespace burnish::definition
