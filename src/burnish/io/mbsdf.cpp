// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <burnish/io/mbsdf.h>
#include <burnish/io/part_choice.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::string_view kMagic = "NVIDIA ARC MBSDF V1\n";
// Older files have one block, of reflection.
constexpr std::string_view kReflection = "MBSDF_DATA_REFLECTION=", kOnly = "MBSDF_DATA=";
constexpr std::string_view kTransmission = "MBSDF_DATA_TRANSMISSION=";
constexpr std::size_t kLongestLine = 4096;
constexpr std::uint32_t kMaxResolution = 2048;

std::string_view read_line(const FileBytes& file, ByteReader& reader) {
  const std::string_view rest = file.text().substr(reader.offset());
  const std::size_t end = rest.substr(0, kLongestLine).find('\n');
  if (end == std::string_view::npos) reader.fail("a line of text", "none");
  reader.seek(reader.offset() + end + 1);
  return rest.substr(0, end);
}

/// The sizes in front of a block's values.
struct BlockHeader {
  std::uint32_t channels, theta_count, phi_count;

  std::uint64_t value_count() const noexcept {
    return std::uint64_t{theta_count} * theta_count * phi_count * channels;
  }
};

/// Reads a block's sizes and makes sure that its values follow.
BlockHeader read_block_header(ByteReader& reader) {
  const auto type = reader.number<std::uint32_t>("a block type");
  if (type > 1) reader.fail("block type 0 (grey) or 1 (RGB)", fmt::format("{}", type));
  const BlockHeader header{type == 1 ? 3u : 1u, reader.number<std::uint32_t>("the resolution of theta"),
                           reader.number<std::uint32_t>("the resolution of phi")};
  for (const std::uint32_t count : {header.theta_count, header.phi_count})
    if (count < 1 || count > kMaxResolution)
      reader.fail(fmt::format("a resolution in [1, {}]", kMaxResolution), fmt::format("{}", count));
  reader.require(header.value_count() * sizeof(float), "values");
  return header;
}

/// Returns the part of the block that a line begins; nothing for another line.
std::optional<BsdfPart> part_begun_by(std::string_view line) noexcept {
  if (line.starts_with(kReflection) || line.starts_with(kOnly)) return BsdfPart::reflection_front;
  return line.starts_with(kTransmission) ? std::optional(BsdfPart::transmission_front) : std::nullopt;
}

/// One block of a file.
struct FoundBlock {
  BsdfPart part;
  BlockHeader header;
  std::uint64_t values_at = 0;
};

/// Passes over the line break behind a block's values. Returns true if more follows.
bool has_more(const FileBytes& file, ByteReader& reader) {
  const std::string_view rest = file.text().substr(reader.offset());
  if (trimmed(rest).empty() || rest == "\n") return false;
  if (rest.starts_with('\n')) reader.seek(reader.offset() + 1);
  return true;
}

/// Finds all blocks; the lines in front of the first become the description.
std::vector<FoundBlock> find_blocks(const FileBytes& file, ByteReader& reader, Findings& findings) {
  std::vector<FoundBlock> blocks;
  read_line(file, reader);
  while (blocks.empty() || has_more(file, reader)) {
    const std::string_view rest = file.text().substr(reader.offset());
    if (!blocks.empty() && !part_begun_by(rest) && rest.substr(0, kLongestLine).find("=") >= rest.find('\n'))
      reader.fail("the end of the file or another block", fmt::format("{} more bytes", reader.remaining()));
    const std::string_view line = read_line(file, reader);
    if (const auto part = part_begun_by(line)) {
      const BlockHeader header = read_block_header(reader);
      blocks.push_back({*part, header, reader.offset()});
      reader.seek(reader.offset() + header.value_count() * sizeof(float));
    } else if (!line.empty()) {
      if (line.find('=') == std::string_view::npos) reader.fail("a line KEY=VALUE", in_quotes(line));
      if (findings.description.size() < 200)
        findings.description += (findings.description.empty() ? "" : ", ") + printable(line, 80);
    }
  }
  return blocks;
}

/// Reads a block's values, all of which must be numbers.
std::vector<float> read_block_values(ByteReader& reader, const FoundBlock& block) {
  reader.seek(block.values_at);
  const std::uint64_t count = block.header.value_count();
  const auto bytes = reader.take(count * sizeof(float), "values");
  std::vector<float> values(count);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) {
      reader.seek(block.values_at + i * sizeof(float));
      reader.fail("a finite value", fmt::format("{}", values[i]));
    }
  return values;
}

/// Chooses a block, and notes the blocks that are left out. Only the first block of each part can be read.
const FoundBlock& chosen_block(const FileBytes& file, const std::vector<FoundBlock>& found,
                               const OpenOptions& options, Findings& findings) {
  std::vector<BsdfBlock> blocks;
  std::vector<const FoundBlock*> first;
  for (const FoundBlock& block : found)
    if (const BsdfBlock named{block.part, {}}; std::ranges::find(blocks, named) == blocks.end()) {
      blocks.push_back(named);
      first.push_back(&block);
    }
  const std::size_t chosen = choose_block(file.name, blocks, options);
  note_blocks(blocks, chosen, options, findings);
  for (const FoundBlock& block : found) {
    if (&block == first[chosen]) continue;
    std::string name = block.part == blocks[chosen].part ? "a second block of " : "";
    name += is_transmission(block.part) ? "transmission" : "reflection";
    if (std::ranges::find(findings.left_out, name) == findings.left_out.end())
      findings.left_out.push_back(std::move(name));
  }
  return *first[chosen];
}

}  // namespace

bool looks_like_mbsdf(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size() - 1) == 0;
}

MbsdfFile parse_mbsdf(const FileBytes& file, const OpenOptions& options) {
  ByteReader reader(file);
  if (!looks_like_mbsdf(file.bytes))
    reader.fail("NVIDIA ARC MBSDF V1", in_quotes(file.text().substr(0, kMagic.size())));
  MbsdfFile result;
  Findings& findings = result.findings;
  findings.format = "NVIDIA MBSDF";
  const std::vector<FoundBlock> found = find_blocks(file, reader, findings);
  const FoundBlock& block = chosen_block(file, found, options, findings);
  const BlockHeader& header = block.header;
  AngleTable& table = result.table;
  table = mbsdf_layout(header.theta_count, header.phi_count);
  table.channel_count = header.channels;
  table.values = read_block_values(reader, block);
  for (const float value : table.values) {
    if (value >= 0) continue;
    ++findings.negative_count;
    findings.most_negative = std::min(findings.most_negative, static_cast<double>(value));
  }
  findings.conventions.insert(
      findings.conventions.begin(),
      {"theta_in is the light's; the azimuth is between the directions, the mirror direction at 180 degrees.",
       "Entries stand for the centres of their cells; linear between them.",
       header.channels == 3 ? "Taken as linear Rec. 709." : "Grey."});
  findings.sample_count = header.value_count() / header.channels;
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return result;
}

AngleTable mbsdf_layout(std::size_t theta_count, std::size_t phi_count) {
  AngleTable table;
  table.folded = true;
  table.axes = {make_axis({0}), make_axis(cell_centres(theta_count, kHalfPi)),
                make_axis(cell_centres(theta_count, kHalfPi)), make_axis(cell_centres(phi_count, kPi))};
  return table;
}

bool fits_mbsdf(const AngleTable& table) noexcept {
  const auto centred = [](const AngleAxis& axis, double extent) {
    const std::size_t count = axis.nodes.size();
    if (count < 1 || count > kMaxResolution) return false;
    const double cell = extent / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i)
      if (!(std::abs(axis.nodes[i] - (static_cast<double>(i) + 0.5) * cell) < 1e-9)) return false;
    return true;
  };
  const auto& axes = table.axes;
  return table.frame == AngleTable::Frame::normal && table.folded && table.isotropic() &&
         axes[1].nodes.size() == axes[2].nodes.size() && centred(axes[1], kHalfPi) &&
         centred(axes[2], kHalfPi) && centred(axes[3], kPi) &&
         (table.channel_count == 1 || table.channel_count == 3);
}

std::string format_mbsdf(const AngleTable& table, BsdfPart part) {
  if (!fits_mbsdf(table)) throw Error("MBSDF: expected an isotropic table of cell centres, grey or RGB");
  std::string bytes = fmt::format("{}{}\n", kMagic, is_transmission(part) ? kTransmission : kReflection);
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(std::uint32_t{table.channel_count == 3});
  append(static_cast<std::uint32_t>(table.axes[1].nodes.size()));
  append(static_cast<std::uint32_t>(table.axes[3].nodes.size()));
  for (const float value : table.values) append(std::isnan(value) ? 0.0f : value);
  return bytes;
}

}  // namespace burnish
