#pragma once

#include <cstddef>
#include <vector>

#include <burnish/reflectance/measured_nodes.h>

namespace burnish {

/// Nodes whose values nodes around them contradict: dust, stray light, a reading of another place. Their indices,
/// rising. Each node is predicted from the 12 nearest others under the default LogCovariance (kriging); an outlier's
/// ln(f + 1e-3) is off by more than five deviations, and by five times more than is usual among the 24 nodes around it,
/// which are as rough and as noisy as it is. It is larger or smaller than all of these, and they stand around it: six of
/// them are nearer to the horizon, three nearer to the mirror direction. One outlier makes its neighbours look wrong: the worst of a neighbourhood
/// goes first, and the others are predicted again without it. Never more than a tenth of the nodes: so many are no
/// outliers, and none is given. Nodes with a cosine of up to 0.02 are not looked at. Deterministic.
/// Source: [Rasmussen 2006, eq. 2.25 and 2.26].
std::vector<std::size_t> outliers_among(const MeasuredNodes& nodes);

/// The other nodes.
MeasuredNodes without_outliers(MeasuredNodes nodes);

}  // namespace burnish
