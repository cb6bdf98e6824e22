#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace burnish::cli {

/// A progress bar on standard error, redrawn in place; silent where standard error is no terminal.
std::function<void(double fraction)> progress_bar(std::string label);

/// One such bar a stage; nothing where standard error is no terminal.
std::function<void(std::string_view stage, double fraction)> progress_bars();

}  // namespace burnish::cli
