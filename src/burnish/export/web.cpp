// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include <burnish/export/web.h>
#include <burnish/factors/table_format.h>

namespace burnish {

std::string web_script(std::string_view file, const std::string& model) {
  constexpr std::string_view kPlace = "MODEL";
  std::string text(text_of(web_files(), file));
  return text.replace(text.find(kPlace), kPlace.size(), model);
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    // three bytes, zeros beyond the end, are four digits of six bits
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string half_texels(const std::vector<float>& values, std::size_t channels) {
  std::vector<float> all;
  const auto step = channels;
  for (std::size_t i = 0; i < values.size(); i += step)
    for (std::size_t c = 0; c < 4; ++c) all.push_back(c == 3 ? 1.0f : values[i + (step == 1 ? 0 : c)]);
  return base64(pack(TableFormat::half, 4, all));
}

}  // namespace burnish
