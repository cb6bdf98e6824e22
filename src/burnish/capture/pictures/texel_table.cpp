// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include <burnish/capture/pictures/texel_table.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/csv.h>

namespace burnish {

namespace {

constexpr std::size_t kHeadBytes = 64 << 10;
constexpr std::size_t kHeldOutSample = 12;  // one of so many samples of a texel, if the file marks none

}  // namespace

bool TexelTable::recognizes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string head(kHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return looks_like_texel_csv(head);
}

TexelTable::TexelTable(const std::filesystem::path& path, int most_side, std::size_t most_pictures) {
  const FileBytes file = read_file(path);
  fingerprint_ = hash_of(file.text());
  const TexelCsv read = parse_texel_csv(file, most_side - 1);

  // The largest texel gives the size of the surface.
  for (const auto& [x, y] : read.texels) {
    width_ = std::max(width_, x + 1);
    height_ = std::max(height_, y + 1);
  }
  const std::size_t texels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  if (read.texels.empty() || read.texels.size() < texels)
    throw Error::in_file(file.name, fmt::format("at least a sample a texel, of {} x {}", width_, height_),
                         fmt::format("{} samples", read.texels.size()));

  // Samples are sorted by texel, in the order of the file.
  const auto texel_of = [&](std::size_t i) {
    return static_cast<std::size_t>(read.texels[i][1]) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(read.texels[i][0]);
  };
  starts_.assign(texels + 1, 0);
  for (std::size_t i = 0; i < read.texels.size(); ++i) ++starts_[texel_of(i) + 1];
  for (std::size_t t = 0; t < texels; ++t) starts_[t + 1] += starts_[t];
  samples_.resize(read.texels.size());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t i = 0; i < read.texels.size(); ++i) {
    const std::size_t texel = texel_of(i), number = next[texel] - starts_[texel];
    Sample& sample = samples_[next[texel]++];
    const auto& [wi, wo] = read.pairs[i];
    std::ranges::transform(std::array{wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, sample.directions.begin(),
                           [](double w) { return static_cast<float>(w); });
    for (std::size_t c = 0; c < 3; ++c) sample.seen[c] = read.f[i][c] * sample.directions[2];
    const bool every = number % kHeldOutSample == kHeldOutSample - 1;
    sample.held_out = read.held_out.empty() ? static_cast<std::uint8_t>(every) : read.held_out[i];
  }

  // There are as many pictures as the texel with most samples has.
  for (std::size_t t = 0; t < texels; ++t) {
    std::size_t held_out = 0;
    for (std::size_t i = starts_[t]; i < starts_[t + 1]; ++i) held_out += samples_[i].held_out;
    held_out_ = std::max(held_out_, held_out);
    fitted_ = std::max(fitted_, starts_[t + 1] - starts_[t] - held_out);
  }
  if (pictures() > most_pictures)
    throw Error::in_file(file.name, fmt::format("at most {} samples a texel", most_pictures),
                         fmt::format("{}", pictures()));
}

CaptureRows TexelTable::rows(int first, int count) const {
  CaptureRows rows{.first_row = first,
                   .rows = count,
                   .width = width_,
                   .pictures = pictures(),
                   .values = {},
                   .states = {},
                   .directions = {}};
  const std::size_t texels = rows.texels(),
                    begin = static_cast<std::size_t>(first) * static_cast<std::size_t>(width_);
  rows.values.resize(3 * rows.pictures * texels);
  rows.states.resize(rows.pictures * texels, PixelState::missing);
  rows.directions.resize(6 * rows.pictures * texels);
  for (std::size_t z = 2; z < rows.directions.size(); z += 3)
    rows.directions[z] = 1;  // missing samples have the normal as direction
  for (std::size_t t = 0; t < texels; ++t) {
    std::size_t next_fitted = 0, next_held_out = fitted_;
    for (std::size_t i = starts_[begin + t]; i < starts_[begin + t + 1]; ++i) {
      const Sample& sample = samples_[i];
      const std::size_t pixel = (sample.held_out ? next_held_out++ : next_fitted++) * texels + t;
      rows.states[pixel] = PixelState::there;
      std::ranges::copy(sample.seen, &rows.values[3 * pixel]);
      std::ranges::copy(sample.directions, &rows.directions[6 * pixel]);
    }
  }
  return rows;
}

}  // namespace burnish
