// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace burnish {

/// Which LAPACK is linked, as it says itself ("LAPACK 3.9.0"), or what stands in its place.
std::string linear_algebra();

}  // namespace burnish
