#pragma once

#include <string>
#include <vector>

#include <burnish/source.h>

#include "report.h"

namespace burnish::reports {

/// What the pages about costs fit, isotropic and of three channels: every such file of the folder `rgl` of the
/// measurements, by name; without measurements tables that a virtual goniometer makes of formulas. `quick`: the
/// first alone.
std::vector<Source> cost_sources(const ReportOptions& options);

}  // namespace burnish::reports
