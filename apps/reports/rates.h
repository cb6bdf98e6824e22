#pragma once

#include <string>
#include <vector>

#include "frames.h"
#include "report.h"

namespace burnish::reports {

/// Billions of evaluations a second of each material in a compute shader, of random pairs that it makes itself: the
/// most, the median in brackets, and how many times the first one's time each takes; `first` names it. Needs a
/// GlContext.
Table evaluation_rates(const std::string& first, const std::vector<FrameMaterial>& materials,
                       int repetitions);

}  // namespace burnish::reports
