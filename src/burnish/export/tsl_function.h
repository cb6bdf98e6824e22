// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/formula/expression.h>

namespace burnish {

/// Returns JavaScript `function reflectance(TSL, read, wi, wo)` that makes nodes of three.js's shading language of a
/// formula over the vectors wi and wo: a vec3, zero unless both are above the horizon. `read(name, u, v)` and
/// `read(name, u, v, w)` give the filtered texel of a texture. Throws Error for operations that evaluations of BRDFs
/// do not have.
std::string tsl_function(const Expr& value);

}  // namespace burnish
