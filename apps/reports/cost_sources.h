// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/source.h>

#include "report.h"

namespace burnish::reports {

/// Returns the isotropic sources of three channels that the pages on costs fit. They are all such files of the
/// measurements' folder `rgl`, by name. Without measurements they are tables that a virtual goniometer makes of
/// formulas. `quick` returns the first alone.
std::vector<Source> cost_sources(const ReportOptions& options);

}  // namespace burnish::reports
