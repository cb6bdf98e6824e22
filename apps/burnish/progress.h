#pragma once

#include <functional>
#include <string>

namespace burnish::cli {

/// A progress bar on standard error, redrawn in place; silent where standard error is no terminal.
std::function<void(double fraction)> progress_bar(std::string label);

}  // namespace burnish::cli
