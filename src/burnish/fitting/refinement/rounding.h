// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/fitting/refinement/refine.h>

namespace burnish {

/// The model as it is stored: as to_brdf, but where it lowers the error that `options` weigh, what rounding a
/// node does wrong is made good by the nodes that are not rounded yet: x - x^ at node q moves the rest by
/// -(x_q - x^_q) / U_qq U_q, where U^T U is the inverse of the Gauss-Newton matrix [Frantar2022]. Tables of
/// up to 2,000 unknowns are rounded together. It matters where a format holds few bits of a channel far below
/// its texel's largest.
FactoredBrdf to_rounded_brdf(const LogModel& model, const TrainingSet& set, const RefineOptions& options);

}  // namespace burnish
