#include "environment_argument.h"

#include <memory>

#include <burnish/file.h>
#include <burnish/render/light/sky_image.h>

namespace burnish::cli {

void add_environment_argument(CLI::App& verb, std::string& text) {
  verb.add_option(
      "--environment", text,
      "light from all around: sun, studio, or an OpenEXR picture of all directions, twice as wide as "
      "high, y up, x in its middle");
}

std::optional<Environment> environment_of(const std::string& text) {
  if (text.empty()) return {};
  if (const auto known = find_environment(text)) return known;
  return Environment{.name = "picture",
                     .picture = std::make_shared<const SkyImage>(parse_sky(read_file(text)))};
}

}  // namespace burnish::cli
