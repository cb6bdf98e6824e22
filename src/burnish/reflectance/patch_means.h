// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/patch_table.h>

namespace burnish {

/// Returns the means of a source over all pairs of patches, weighted by both projected solid angles. So each incident
/// patch keeps the mean of its albedo, and each outgoing patch its share of it. The mean is that of 3 x 3 places in
/// each patch. Unknown places count as zero.
PatchTable patch_means(BrdfRef source, PatchBasis incident, PatchBasis outgoing);

}  // namespace burnish
