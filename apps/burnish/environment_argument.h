// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <burnish/render/light/environment_light.h>

namespace burnish::cli {

/// Adds `--environment`. `text` must outlive the parse.
void add_environment_argument(CLI::App& verb, std::string& text);

/// Opens an environment by its name or its picture; returns nothing for an empty text. Throws Error for a file that is
/// no picture of a sky.
std::optional<Environment> environment_of(const std::string& text);

}  // namespace burnish::cli
