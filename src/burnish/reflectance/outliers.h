// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// Returns the indices, rising, of nodes whose values contradict those around them: dust, stray light, a reading of
/// another place. Each node is predicted from the 12 nearest others under the default LogCovariance (kriging). An
/// outlier's ln(f + 1e-3) is off by more than ln 2, by more than five deviations, and by five times more than is usual
/// among the 24 nodes around it, which are as rough and as noisy as it is. Its value is larger or smaller than all of
/// theirs. At least six of these nodes are nearer to the horizon, three nearer to the mirror direction, and three have a
/// direction nearer to the normal.
/// One outlier makes its neighbours look wrong. So the worst of a neighbourhood goes first, and the others are
/// predicted again without it. If more than a tenth of the nodes were outliers, none is returned. Nodes with a cosine
/// of up to 0.02 are not examined. Deterministic.
/// Source: [Rasmussen 2006, eq. 2.25 and 2.26].
std::vector<std::size_t> outliers_among(const MeasuredNodes& nodes);

/// Returns the nodes without outliers.
MeasuredNodes without_outliers(MeasuredNodes nodes);

}  // namespace burnish
