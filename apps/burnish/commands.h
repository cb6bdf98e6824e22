#pragma once

#include <CLI/CLI.hpp>

namespace burnish::cli {

// Each verb lives in NAME_command.cpp: it adds its options to the application and a callback that calls the
// library.

}  // namespace burnish::cli
