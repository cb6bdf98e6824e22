// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "frames.h"
#include "report.h"

namespace burnish::reports {

/// Returns a table of billions of evaluations a second of each material in a compute shader, which makes its own random
/// pairs. It has the most, the median in brackets, and the ratio of each time to the first material's. `first` names
/// that material. Needs a GlContext.
Table evaluation_rates(const std::string& first, const std::vector<FrameMaterial>& materials,
                       int repetitions);

}  // namespace burnish::reports
