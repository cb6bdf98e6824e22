// SPDX-License-Identifier: Apache-2.0
#include "environment_argument.h"

namespace burnish::cli {

void add_environment_argument(CLI::App& verb, std::string& text) {
  verb.add_option("--environment", text,
                  "Adds light from all around: sun, studio, or an OpenEXR picture, twice as wide as high, y "
                  "up, x in its middle.");
}

std::optional<Environment> environment_of(const std::string& text) {
  if (text.empty()) return {};
  return open_environment(text);
}

}  // namespace burnish::cli
