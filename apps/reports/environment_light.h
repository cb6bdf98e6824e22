#pragma once

#include "report.h"

namespace burnish::reports {

/// How far image-based light is from Monte Carlo: a section of the page on shaders, and
/// environment-light.png. Needs a GlContext.
void report_environment_light(Page& page);

}  // namespace burnish::reports
