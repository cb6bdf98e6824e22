#include <algorithm>
#include <stdexcept>
#include <string>

#include <burnish/embedded_file.h>

namespace burnish {

std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name) {
  const auto found = std::ranges::find(files, name, &EmbeddedFile::name);
  if (found == files.end()) throw std::logic_error("no embedded file " + std::string(name));
  return found->text;
}

}  // namespace burnish
