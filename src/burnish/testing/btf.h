// SPDX-License-Identifier: Apache-2.0
#pragma once

// Files as the University of Bonn writes them, for tests and fuzzers.

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Imath/half.h>

namespace burnish {

/// The content of a BTF file of signature !DFMF08FCR.
struct BtfContent {
  std::uint32_t width = 5, height = 2, version = 4;
  float pixels_per_mm = 10;
  std::uint32_t with_cosine = 0;
  std::vector<std::array<float, 2>> lights{{0.1f, 0}, {0.5f, 1}, {1.2f, -2}}, views{{0, 0}, {0.7f, 3}};
  std::int32_t colours = 0;
  std::array<float, 3> mean{};
  std::array<float, 9> transform{1, 0, 0, 0, 1, 0, 0, 0, 1};
  int scalar_bytes = 4;
  bool texels_first = false;
  std::array<std::size_t, 3> components{2, 1, 1};
  std::array<std::vector<double>, 3> pictures;  ///< [channel][light + lights * view][component]
  std::array<std::vector<double>, 3> texels;    ///< [channel][row][x][component]

  std::size_t picture_count() const { return lights.size() * views.size(); }

  /// Returns the sum over the components of a channel.
  double product(std::size_t channel, std::size_t picture, std::size_t texel) const {
    double sum = 0;
    const std::size_t count = components[channel];
    for (std::size_t k = 0; k < count; ++k)
      sum += pictures[channel][picture * count + k] * texels[channel][texel * count + k];
    return sum;
  }
};

/// Returns content whose numbers are multiples of 2^-5, which every scalar type holds.
inline BtfContent btf_content() {
  BtfContent content;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < content.picture_count() * content.components[c]; ++i)
      content.pictures[c].push_back(static_cast<double>((7 * i + 3 * c) % 11) / 32 - (c > 0 ? 0.125 : 0));
    for (std::size_t i = 0; i < std::size_t{content.width} * content.height * content.components[c]; ++i)
      content.texels[c].push_back(static_cast<double>((5 * i + c) % 13) / 32 + 0.0625);
  }
  return content;
}

/// Returns the file of this content.
inline std::string btf_bytes(const BtfContent& content) {
  std::string file = "!DFMF08FCR";
  const auto put = [&file](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  const auto put_text = [&](const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    file += text;
  };
  const std::size_t begin = file.size();
  put(std::uint32_t{0});
  put(content.version);
  file += std::string(3 * 80, 's');
  put(content.pixels_per_mm);
  for (int c = 0; c < 3; ++c) put(1.0f);
  if (content.version > 1) put(content.with_cosine);
  if (content.version > 2) put_text("<measurement/>");
  if (content.version > 3) {
    put(std::uint32_t{3});
    for (const char* name : {"R", "G", "B"}) put_text(name);
  }
  const auto size = static_cast<std::uint32_t>(file.size() - begin);
  std::memcpy(file.data() + begin, &size, sizeof(size));
  put(static_cast<std::uint32_t>(content.views.size()));
  for (const auto& view : content.views) {
    put(view);
    put(static_cast<std::uint32_t>(content.lights.size()));
    for (const auto& light : content.lights) put(light);
  }
  put(content.width);
  put(content.height);
  put(std::uint32_t{0});
  put(std::uint32_t{9});
  put(content.colours);
  put(content.mean);
  put(content.transform);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto put_numbers = [&](const std::vector<double>& numbers) {
      for (const double value : numbers) {
        if (content.scalar_bytes == 2) put(Imath::half(static_cast<float>(value)).bits());
        if (content.scalar_bytes == 4) put(static_cast<float>(value));
        if (content.scalar_bytes == 8) put(value);
      }
    };
    const std::array matrices{&content.pictures[c], &content.texels[c]};
    put(static_cast<std::uint8_t>(content.scalar_bytes));
    put(static_cast<std::uint32_t>(content.components[c]));
    for (const std::size_t m : {std::size_t{0}, std::size_t{1}})
      put(static_cast<std::uint32_t>(matrices[m ^ content.texels_first]->size() / content.components[c]));
    put_numbers(std::vector<double>(content.components[c], 1));
    for (const std::size_t m : {std::size_t{0}, std::size_t{1}})
      put_numbers(*matrices[m ^ content.texels_first]);
  }
  return file;
}

}  // namespace burnish
