#pragma once

#include <filesystem>

namespace burnish {

/// Prints how far image-based light is from Monte Carlo, as Markdown, and writes environment-light.png into
/// the folder. Needs a GlContext.
void print_environment_light(const std::filesystem::path& figures);

}  // namespace burnish
