// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <burnish/short_message.h>

namespace burnish {

namespace {

constexpr std::string_view kGap = " ... ";
constexpr std::size_t kKeptEnd = 120;

}  // namespace

std::string short_message(std::string_view message, std::size_t longest) {
  std::string line(message.substr(0, message.find_last_not_of("\r\n \t") + 1));
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  if (line.size() <= longest) return line;
  // whole characters of UTF-8: no cut before a byte that continues one
  const auto continues = [&](std::size_t at) {
    return at < line.size() && (static_cast<unsigned char>(line[at]) & 0xc0) == 0x80;
  };
  std::size_t begin = longest - kGap.size() - kKeptEnd, end = line.size() - kKeptEnd;
  while (begin > 0 && continues(begin)) --begin;
  while (continues(end)) ++end;
  return line.substr(0, begin) + std::string(kGap) + line.substr(end);
}

}  // namespace burnish
