// SPDX-License-Identifier: Apache-2.0
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

std::string with_marks(std::string_view text, const std::map<std::string_view, std::string>& marks) {
  const auto is_capital = [](char c) { return 'A' <= c && c <= 'Z'; };
  std::string result;
  while (true) {
    // up to the next mark, then what stands for it
    const std::size_t at = text.find('@');
    result += text.substr(0, at);
    if (at == std::string_view::npos) return result;
    text.remove_prefix(at + 1);
    const auto end = std::find_if_not(text.begin(), text.end(), is_capital);
    const std::string_view mark = text.substr(0, static_cast<std::size_t>(end - text.begin()));
    const auto found = marks.find(mark);
    if (found == marks.end()) throw std::logic_error("no text for the mark @" + std::string(mark));
    result += found->second;
    text.remove_prefix(mark.size());
  }
}

}  // namespace burnish
