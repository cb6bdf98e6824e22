// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "power_baselines_bench.h"

namespace burnish {

/// Returns Highway's FastPow with and without subnormal numbers, and its Exp(e Log c), for AVX2 and AVX-512. Empty if
/// the build found no headers of the pinned version (tests/rivals/fetch.sh brings them), or for another processor.
std::vector<PowerBaseline> highway_rivals();

/// Returns the version of these headers, or "absent".
std::string highway_rival_version();

}  // namespace burnish
