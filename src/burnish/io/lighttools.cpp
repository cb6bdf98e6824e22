// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>

#include <burnish/io/lighttools.h>
#include <burnish/io/part_choice.h>
#include <burnish/io/spectral_table.h>
#include <burnish/io/stated_totals.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/math/rec709_d65.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxLightToolsAngles = 4096, kMaxLightToolsBlocks = 65536;
constexpr double kLightAzimuth_deg = 90;
/// The keywords that a block can begin with.
constexpr std::string_view kBlockKeywords[] = {"AOI",         "POI",        "Side",
                                               "ScatterType", "Wavelength", "TristimulusValue"};

bool begins_block(std::string_view word) noexcept {
  return std::ranges::find(kBlockKeywords, word) != std::end(kBlockKeywords);
}

/// Returns the next word, which may stand on a later line. Throws Error at the end of the file.
std::string_view word_ahead(TextReader& reader, std::string_view what) {
  for (;;) {
    if (const std::string_view word = reader.word(); !word.empty()) {
      if (!word.starts_with('#')) return word;
    }
    if (!reader.next_content_line()) reader.fail(std::string(what), "the end of the file");
  }
}

double number_ahead(TextReader& reader, std::string_view what) {
  const std::string_view word = word_ahead(reader, what);
  if (const auto value = parse_number(word)) return *value;
  reader.fail(fmt::format("a finite number for {}", what), in_quotes(word));
}

std::vector<double> scatter_angles(TextReader& reader, std::string_view keyword, double most) {
  const double count = number_ahead(reader, fmt::format("the number of {} angles", keyword));
  if (!(count >= 1 && count <= static_cast<double>(kMaxLightToolsAngles) && count == std::floor(count)))
    reader.fail(fmt::format("1 to {} angles", kMaxLightToolsAngles), fmt::format("{}", count));
  std::vector<double> angles;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const double angle = number_ahead(reader, keyword);
    if (!(angle >= 0 && angle <= most) || (k > 0 && angle <= angles.back()))
      reader.fail(fmt::format("increasing {} in [0, {}] degrees", keyword, most), fmt::format("{}", angle));
    angles.push_back(angle);
  }
  return angles;
}

/// The header: colour and the angles of every block, in degrees.
struct LightToolsHeader {
  bool colour = false;
  std::vector<double> azimuths, radials;

  std::size_t entries() const noexcept { return azimuths.size() * radials.size(); }
  std::size_t channels() const noexcept { return colour ? 3 : 1; }
};

/// Reads keywords up to DataBegin.
LightToolsHeader read_lighttools_header(TextReader& reader) {
  LightToolsHeader header;
  bool has_content = false;
  for (;;) {
    const std::string_view keyword = word_ahead(reader, "DataBegin");
    if (keyword == "DataBegin") break;
    if (keyword == "SpectralContent") {
      const std::string_view content = word_ahead(reader, "the spectral content");
      if (content != "Monochrome" && content != "XYZ")
        reader.fail("SpectralContent Monochrome or XYZ", in_quotes(content));
      header.colour = content == "XYZ";
      has_content = true;
    } else if (keyword == "Symmetry") {
      const std::string_view symmetry = word_ahead(reader, "the symmetry");
      // The azimuths say the same, so the word itself is not needed.
      if (symmetry != "PlaneSymmetrical" && !symmetry.starts_with("Asymmetric"))
        reader.fail("Symmetry PlaneSymmetrical or Asymmetric", in_quotes(symmetry));
    } else if (keyword == "ScatterAzimuth") {
      header.azimuths = scatter_angles(reader, keyword, 360);
    } else if (keyword == "ScatterRadial") {
      header.radials = scatter_angles(reader, keyword, 90);
    }
    // Other keywords describe the measurement.
  }
  const std::pair<bool, const char*> needed[] = {{has_content, "SpectralContent"},
                                                 {!header.azimuths.empty(), "ScatterAzimuth"},
                                                 {!header.radials.empty(), "ScatterRadial"}};
  for (const auto& [present, keyword] : needed)
    if (!present) reader.fail(fmt::format("the keyword {}", keyword), "none");
  return header;
}

/// One block: the values of a channel at one incidence.
struct ScatterBlock {
  double aoi = 0, poi = 0, tis = 0, lambda_nm = 0;
  bool back = false, transmits = false;
  std::size_t channel = 0;
  std::vector<double> values;

  BsdfPart part() const noexcept {
    return transmits ? (back ? BsdfPart::transmission_back : BsdfPart::transmission_front)
                     : (back ? BsdfPart::reflection_back : BsdfPart::reflection_front);
  }
};

double incidence_of(TextReader& reader) {
  const double aoi = number_ahead(reader, "AOI");
  if (aoi == 180) return 0;  // the normal of the back
  if (!(aoi >= 0 && aoi <= 90)) reader.fail("AOI in [0, 90] degrees, or 180", fmt::format("{}", aoi));
  return aoi;
}

std::size_t tristimulus_of(TextReader& reader) {
  const std::string_view word = word_ahead(reader, "the tristimulus value");
  constexpr std::array kNames{"TrisX", "TrisY", "TrisZ"};
  const auto found = std::ranges::find(kNames, word);
  if (found == kNames.end()) reader.fail("TristimulusValue TrisX, TrisY or TrisZ", in_quotes(word));
  return static_cast<std::size_t>(found - kNames.begin());
}

/// Reads keywords and values of one block; returns false at DataEnd.
bool read_scatter_block(TextReader& reader, const LightToolsHeader& header, ScatterBlock& block) {
  for (bool begun = false;; begun = true) {
    const std::string_view keyword = word_ahead(reader, "a block or DataEnd");
    if (keyword == "DataEnd") {
      if (begun) reader.fail("TIS and the values of a block", "DataEnd");
      return false;
    }
    if (keyword == "AOI") {
      block.aoi = incidence_of(reader);
    } else if (keyword == "POI") {
      block.poi = number_ahead(reader, keyword);
    } else if (keyword == "Wavelength") {
      block.lambda_nm = number_ahead(reader, keyword);
    } else if (keyword == "TristimulusValue") {
      block.channel = header.colour ? tristimulus_of(reader) : (tristimulus_of(reader), 0);
    } else if (keyword == "Side") {
      const std::string_view side = word_ahead(reader, "the side");
      if (side != "Front" && side != "Back") reader.fail("Side Front or Back", in_quotes(side));
      block.back = side == "Back";
    } else if (keyword == "ScatterType") {
      const std::string_view type = word_ahead(reader, "the type");
      if (type != "BRDF" && type != "BTDF") reader.fail("ScatterType BRDF or BTDF", in_quotes(type));
      block.transmits = type == "BTDF";
    } else if (keyword == "TIS") {
      block.tis = number_ahead(reader, keyword);
      break;
    } else {
      reader.fail("a keyword of a block", in_quotes(keyword));
    }
  }
  // A value takes at least a digit and a separator.
  if (2 * header.entries() > reader.remaining() + reader.line().size() + 1)
    reader.fail(fmt::format("{} values", header.entries()),
                fmt::format("{} bytes to the end", reader.remaining()));
  for (std::size_t k = 0; k < header.entries(); ++k) {
    const double value = number_ahead(reader, "a value");
    if (std::abs(value) > 1e30) reader.fail("a value below 1e30", fmt::format("{}", value));
    block.values.push_back(value);
  }
  return true;
}

std::vector<ScatterBlock> read_scatter_blocks(TextReader& reader, const LightToolsHeader& header) {
  std::vector<ScatterBlock> blocks;
  for (ScatterBlock block; read_scatter_block(reader, header, block); block = {}) {
    if (blocks.size() == kMaxLightToolsBlocks)
      reader.fail(fmt::format("at most {} blocks", kMaxLightToolsBlocks), "more");
    if (!blocks.empty() && blocks.front().poi != block.poi)
      reader.fail("one plane of incidence, POI", fmt::format("{} and {}", blocks.front().poi, block.poi));
    blocks.push_back(std::move(block));
  }
  if (blocks.empty()) reader.fail("a block of values", "DataEnd");
  return blocks;
}

/// A node of the azimuth phi_o - phi_i, and its place among the file's azimuths.
struct ScatterAzimuth {
  double node_deg;
  std::size_t at;
};

/// Returns the azimuths that the table keeps, by rising nodes; `folded` if all lie in one half.
std::vector<ScatterAzimuth> scatter_azimuths(const std::vector<double>& azimuths_deg, bool& folded) {
  std::vector<ScatterAzimuth> nodes;
  // The plane of incidence divides the circle at 90 and 270 degrees.
  const auto within = [&](double low, double high) {
    return std::ranges::all_of(azimuths_deg, [&](double a) { return a >= low && a <= high; });
  };
  const auto other_half = [&] {
    return std::ranges::all_of(azimuths_deg, [](double a) { return a <= 90 || a >= 270; });
  };
  folded = azimuths_deg.size() > 1 && (within(90, 270) || other_half());
  for (std::size_t k = 0; k < azimuths_deg.size(); ++k) {
    const double azimuth = azimuths_deg[k];
    if (azimuth == 360 && azimuths_deg.front() == 0) continue;  // the same as 0
    double node = std::fmod(azimuth - kLightAzimuth_deg + 360, 360);
    if (folded && node > 180) node = 360 - node;
    nodes.push_back({node, k});
  }
  std::ranges::sort(nodes, {}, &ScatterAzimuth::node_deg);
  return nodes;
}

/// Returns the band of a block: its wavelength if the file has several.
std::string band_of(const ScatterBlock& block, bool several) {
  return several ? fmt::format("{} nm", block.lambda_nm) : std::string();
}

/// Fills the table with the chosen blocks and returns the stated totals, those of Y of XYZ.
std::vector<double> fill_scatter(const std::string& file, const LightToolsHeader& header,
                                 const std::vector<const ScatterBlock*>& chosen, AngleTable& table) {
  bool folded = false;
  const std::vector<ScatterAzimuth> azimuths = scatter_azimuths(header.azimuths, folded);
  std::map<double, std::size_t> incidences;
  for (const ScatterBlock* block : chosen) incidences.emplace(block->aoi, 0);
  std::vector<double> theta_i, theta_o, phi;
  for (auto& [aoi, at] : incidences) {
    at = theta_i.size();
    theta_i.push_back(radians(aoi));
  }
  for (const double radial : header.radials) theta_o.push_back(radians(radial));
  for (const ScatterAzimuth& azimuth : azimuths) phi.push_back(radians(azimuth.node_deg));
  table.folded = folded;
  table.axes = {make_axis({0}, kTwoPi), make_axis(theta_i), make_axis(theta_o),
                make_axis(phi, folded ? 0 : kTwoPi)};
  table.channel_count = header.channels();
  table.values.assign(entry_count(table) * table.channel_count, 0.0f);

  std::vector<double> totals(theta_i.size());
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const ScatterBlock* block : chosen) {
    const std::size_t i = incidences.at(block->aoi);
    if (!seen.emplace(i, block->channel).second)
      throw Error::in_file(file, "one block for each AOI and channel",
                           fmt::format("two at {} degrees", block->aoi));
    if (block->channel == header.channels() / 2) totals[i] = block->tis;
    for (std::size_t t = 0; t < theta_o.size(); ++t)
      for (std::size_t a = 0; a < azimuths.size(); ++a)
        table
            .values[((i * theta_o.size() + t) * azimuths.size() + a) * table.channel_count + block->channel] =
            static_cast<float>(block->values[azimuths[a].at * theta_o.size() + t]);
  }
  if (seen.size() != theta_i.size() * header.channels())
    throw Error::in_file(file, "blocks of TrisX, TrisY and TrisZ for each AOI", "fewer");
  return totals;
}

}  // namespace

bool looks_like_lighttools(std::string_view text) noexcept {
  text = text.substr(0, 65536);
  bool begun = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (begun && !line.empty() && !line.starts_with('#'))
      return begins_block(line.substr(0, line.find_first_of(" \t")));
    begun = begun || line == "DataBegin";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

LightToolsFile parse_lighttools(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  const LightToolsHeader header = read_lighttools_header(reader);
  const std::vector<ScatterBlock> blocks = read_scatter_blocks(reader, header);

  std::set<double> wavelengths;
  for (const ScatterBlock& block : blocks) wavelengths.insert(block.lambda_nm);
  const bool several = !header.colour && wavelengths.size() > 1;
  std::vector<BsdfBlock> parts;
  for (const ScatterBlock& block : blocks)
    if (const BsdfBlock part{block.part(), band_of(block, several)};
        std::ranges::find(parts, part) == parts.end())
      parts.push_back(part);
  const std::size_t taken = choose_block(file.name, parts, options);
  std::vector<const ScatterBlock*> chosen;
  for (const ScatterBlock& block : blocks)
    if (block.part() == parts[taken].part && band_of(block, several) == parts[taken].band)
      chosen.push_back(&block);

  LightToolsFile result;
  Findings& findings = result.findings;
  const std::vector<double> totals = fill_scatter(file.name, header, chosen, result.table);
  findings.format = "LightTools BSDF";
  note_blocks(parts, taken, options, findings);
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (k != taken) findings.left_out.push_back(to_string(parts[k]));
  findings.conventions.insert(
      findings.conventions.begin(),
      {fmt::format("Azimuths about the normal; the light comes from 90 degrees, {} is at 270.",
                   findings.transmits() ? "straight on" : "the mirror direction"),
       "Values are f without the cosine; linear between angles. Isotropic."});
  if (result.table.folded) findings.conventions.push_back("Symmetric about the plane of incidence.");
  if (header.colour) {
    findings.conventions.push_back("XYZ became linear Rec. 709 for a D65 white.");
    for (std::size_t k = 0; k < result.table.values.size(); k += 3) {
      float* v = &result.table.values[k];
      const auto rgb =
          rec709_of_d65({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
      for (std::size_t c = 0; c < 3; ++c) v[c] = static_cast<float>(rgb[c]);
    }
  }
  note_table(result.table, findings);
  if (options.scale_to_tis)
    scale_to_totals(result.table, totals, findings);
  else
    check_totals(result.table, totals, findings);
  return result;
}

}  // namespace burnish
