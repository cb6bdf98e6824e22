// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/part_choice.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>

namespace burnish {

namespace {

/// Returns the rank of a band: the visible spectrum first, then a band without a name, then others in the file's order.
int rank_of_band(std::string_view band) noexcept {
  return same_name(band, "Visible") ? 0 : same_name(band, "CIE-Y") ? 1 : band.empty() ? 2 : 3;
}

/// Returns the rank of a part in the order of preference.
int rank_of_part(BsdfPart part, bool back_first) noexcept {
  const bool other = is_back(part) != back_first && !is_transmission(part);
  return is_transmission(part) ? 2 + is_back(part) : other;
}

std::string listed_blocks(std::span<const BsdfBlock> blocks) {
  constexpr std::size_t kMost = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(blocks.size(), kMost); ++i)
    text += (text.empty() ? "" : ", ") + to_string(blocks[i]);
  return blocks.size() > kMost ? text + fmt::format(" and {} more", blocks.size() - kMost) : text;
}

/// Returns the request of the options in words: "part transmission-back in band 'NIR'".
std::string asked_for(const OpenOptions& options) {
  std::string text = options.part ? fmt::format("part {}", to_string(*options.part)) : "";
  if (!options.band.empty())
    text += fmt::format("{}band {}", text.empty() ? "" : " in ", in_quotes(printable(options.band, 40)));
  return text;
}

bool is_asked_for(const BsdfBlock& block, const OpenOptions& options) noexcept {
  return (!options.part || block.part == *options.part) &&
         (options.band.empty() || same_name(block.band, options.band));
}

}  // namespace

std::size_t choose_block(const std::string& file, std::span<const BsdfBlock> blocks,
                         const OpenOptions& options) {
  std::optional<std::size_t> best;
  const auto rank = [&](const BsdfBlock& block) {
    return std::pair(rank_of_part(block.part, options.back_side), rank_of_band(block.band));
  };
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (is_asked_for(blocks[i], options) && (!best || rank(blocks[i]) < rank(blocks[*best]))) best = i;
  if (!best) throw Error::in_file(file, asked_for(options), listed_blocks(blocks));
  return *best;
}

void check_block(const std::string& file, const Findings& findings, const OpenOptions& options) {
  const BsdfBlock block = findings.block.value_or(BsdfBlock{});
  if (is_asked_for(block, options)) return;
  throw Error::in_file(file, asked_for(options),
                       fmt::format("{} alone ({})", to_string(block), findings.format));
}

void note_blocks(std::span<const BsdfBlock> blocks, std::size_t chosen, const OpenOptions& options,
                 Findings& findings) {
  findings.blocks.assign(blocks.begin(), blocks.end());
  findings.block = blocks[chosen];
  if (!findings.transmits()) return;
  findings.conventions.push_back(
      "Transmission: wo is mirrored through the surface, so that light that goes straight on leaves in the "
      "mirror direction.");
  if (!options.part)
    findings.warnings.push_back(
        fmt::format("The file has no reflection: {} was read.", to_string(findings.block->part)));
}

}  // namespace burnish
