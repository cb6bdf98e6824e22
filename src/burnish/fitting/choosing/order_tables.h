// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// True if the order of the directions matters for an isotropic source: exchanging them changes it by more than a
/// percent (reciprocity_error). Models of these sources have tables that only wi looks up. A source that was made
/// reciprocal needs none.
bool order_matters(BrdfRef source);

}  // namespace burnish
