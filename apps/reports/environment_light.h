// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report.h"

namespace burnish::reports {

/// Measures the difference of image-based light from Monte Carlo, for a section of the page on shaders. Draws
/// environment-light.png. Needs a GlContext.
void report_environment_light(Page& page);

}  // namespace burnish::reports
