// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <burnish/capture/ranks/sampled_texels.h>
#include <burnish/capture/ranks/shared_work.h>
#include <burnish/math/random.h>

namespace burnish {

namespace {

/// Returns x and y of the sampled texels, row by row.
std::vector<std::array<int, 2>> spread_texels(int width, int height, std::size_t count, std::uint64_t seed) {
  const double cell =
      std::max(1.0, std::sqrt(static_cast<double>(width) * height / static_cast<double>(count)));
  const int across = std::max(1, static_cast<int>(width / cell)),
            down = std::max(1, static_cast<int>(height / cell));
  Pcg32 random(seed, 77);
  std::vector<std::array<int, 2>> texels;
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      const double x = (i + random.uniform()) * width / across, y = (j + random.uniform()) * height / down;
      texels.push_back({std::min(width - 1, static_cast<int>(x)), std::min(height - 1, static_cast<int>(y))});
    }
  std::ranges::sort(texels, {}, [](const std::array<int, 2>& t) { return std::pair(t[1], t[0]); });
  return texels;
}

SampledTexels empty_sample(const CaptureForm& form, std::size_t most_values, std::uint64_t seed) {
  const std::size_t pictures = form.pictures.size();
  SampledTexels found;
  TexelSamples& all = found.samples;
  all.texels =
      spread_texels(form.width, form.height, std::max<std::size_t>(1, most_values / (3 * pictures)), seed);
  all.pictures = pictures;
  all.values.resize(pictures * all.size() * 3);
  all.states.resize(pictures * all.size());
  if (form.own_directions) all.directions.resize(6 * pictures * all.size());
  return found;
}

/// Returns the place of the first sampled texel in or below a row.
std::size_t first_from(const TexelSamples& all, int row) {
  return static_cast<std::size_t>(
      std::ranges::lower_bound(all.texels, row, {}, [](const std::array<int, 2>& t) { return t[1]; }) -
      all.texels.begin());
}

/// Copies the sampled texels of some rows.
void keep_rows(const CaptureRows& rows, const CaptureForm& form, SampledTexels& found) {
  TexelSamples& all = found.samples;
  const std::size_t begin = first_from(all, rows.first_row),
                    end = first_from(all, rows.first_row + rows.rows), texels = rows.texels();
  for (std::size_t p = 0; p < all.pictures; ++p) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::size_t from =
          p * texels +
          static_cast<std::size_t>(all.texels[t][1] - rows.first_row) * static_cast<std::size_t>(form.width) +
          static_cast<std::size_t>(all.texels[t][0]);
      std::copy_n(&rows.values[3 * from], 3, &all.values[3 * (p * all.size() + t)]);
      all.states[p * all.size() + t] = rows.states[from];
      if (!all.directions.empty())
        std::copy_n(&rows.directions[6 * from], 6, &all.directions[6 * (p * all.size() + t)]);
    }
    if (form.pictures[p].held_out || form.own_directions)
      continue;  // texels have different numbers of samples
    const auto states = std::span(rows.states).subspan(p * texels, texels);
    found.missing += static_cast<std::size_t>(std::ranges::count(states, PixelState::missing));
    found.clipped += static_cast<std::size_t>(
        std::ranges::count_if(states, [](PixelState state) { return is_clipped(state); }));
  }
}

/// Samples by the ranks of a crew; returns nothing if a picture is damaged.
std::optional<SampledTexels> sample_by_crew(Capture& capture, std::size_t most_values, std::size_t tile_bytes,
                                            std::uint64_t seed, FitCrew& crew) {
  const CaptureForm& form = capture.form();
  SampledTexels found = empty_sample(form, most_values, seed);
  TexelSamples& all = found.samples;
  const int step = std::min(capture.rows_within(tile_bytes), (form.height + crew.ranks() - 1) / crew.ranks());
  const auto tiles = static_cast<std::size_t>((form.height + step - 1) / step);
  const auto range_of = [&](std::size_t tile) {
    const int row = static_cast<int>(tile) * step;
    const std::size_t begin = first_from(all, row), end = first_from(all, row + step);
    return std::pair(begin, end > begin ? end - begin : 0);
  };
  // The result of a tile says if it is sound, then has the counts and the sampled values.
  const auto made = made_together(&crew, tiles, [&](std::size_t tile) {
    const int row = static_cast<int>(tile) * step;
    SampledTexels own{.samples = std::move(all)};
    const Capture::Read read = capture.read(row, std::min(step, form.height - row));
    if (read.damaged.empty()) keep_rows(read.rows, form, own);
    all = std::move(own.samples);
    const std::array<std::uint64_t, 3> counted{read.damaged.empty(), own.missing, own.clipped};
    std::string bytes;
    append_values<std::uint64_t>(bytes, counted);
    const auto [begin, count] = range_of(tile);
    for (std::size_t p = 0; p < all.pictures; ++p) {
      const std::size_t first = p * all.size() + begin;
      append_values<float>(bytes, std::span(all.values).subspan(3 * first, 3 * count));
      append_values<PixelState>(bytes, std::span(all.states).subspan(first, count));
      if (!all.directions.empty())
        append_values<float>(bytes, std::span(all.directions).subspan(6 * first, 6 * count));
    }
    return bytes;
  });
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    std::string_view rest = made[tile];
    std::array<std::uint64_t, 3> counted{};
    take_values<std::uint64_t>(rest, counted);
    if (counted[0] == 0) return std::nullopt;
    found.missing += counted[1];
    found.clipped += counted[2];
    const auto [begin, count] = range_of(tile);
    for (std::size_t p = 0; p < all.pictures; ++p) {
      const std::size_t first = p * all.size() + begin;
      take_values(rest, std::span(all.values.data() + 3 * first, 3 * count));
      take_values(rest, std::span(all.states.data() + first, count));
      if (!all.directions.empty()) take_values(rest, std::span(all.directions.data() + 6 * first, 6 * count));
    }
  }
  return found;
}

}  // namespace

SampledTexels sample_texels(Capture& capture, std::size_t most_values, std::size_t tile_bytes,
                            std::uint64_t seed, const std::function<void(double)>& progress, FitCrew* crew) {
  if (crew && crew->ranks() > 1)
    if (auto found = sample_by_crew(capture, most_values, tile_bytes, seed, *crew)) return std::move(*found);
  for (;;) {
    const CaptureForm& form = capture.form();
    SampledTexels found = empty_sample(form, most_values, seed);
    std::vector<Capture::LeftOut> damaged;
    const int step = capture.rows_within(tile_bytes);
    for (int row = 0; row < form.height && damaged.empty(); row += step) {
      const int rows = std::min(step, form.height - row);
      const Capture::Read read = capture.read(row, rows);
      damaged = read.damaged;
      keep_rows(read.rows, form, found);
      if (progress) progress(static_cast<double>(row + rows) / form.height);
    }
    if (damaged.empty()) return found;
    capture.leave_out(damaged);
  }
}

}  // namespace burnish
