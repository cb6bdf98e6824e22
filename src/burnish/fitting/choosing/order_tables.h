#pragma once

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Whether the order of the directions matters for an isotropic source: exchanging them changes it by more than a
/// percent (reciprocity_error). Models of such a source have tables that wi alone looks up; one made reciprocal
/// has none.
bool order_matters(BrdfRef source);

}  // namespace burnish
