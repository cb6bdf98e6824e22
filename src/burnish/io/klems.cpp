// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <burnish/io/klems.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>
#include <burnish/math/angles.h>
#include <burnish/math/spectrum.h>
#include <burnish/math/written_degrees.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxPatches = 4096;

PatchBasis stated_basis(const WindowXml& xml, pugi::xml_node node) {
  PatchBasis basis;
  double last_deg = 0;
  for (const pugi::xml_node block : node.children("AngleBasisBlock")) {
    const pugi::xml_node bounds = block.child("ThetaBounds");
    const double low_deg = xml.number(bounds, "LowerTheta"), high_deg = xml.number(bounds, "UpperTheta"),
                 count = xml.number(block, "nPhis");
    if (low_deg != last_deg || !(high_deg > low_deg && high_deg <= 90))
      xml.fail("rings that follow each other from 0 to 90 degrees",
               fmt::format("{} ... {}", low_deg, high_deg));
    if (count != std::floor(count) ||
        !(count >= 1 && count + static_cast<double>(basis.size()) <= kMaxPatches))
      xml.fail(fmt::format("at most {} patches", kMaxPatches), fmt::format("a ring of {}", count));
    basis.rings.push_back(
        {radians(low_deg), radians(high_deg), static_cast<std::size_t>(count), basis.size()});
    last_deg = high_deg;
  }
  if (last_deg != 90) xml.fail("an AngleBasis up to 90 degrees", fmt::format("{} degrees", last_deg));
  return basis;
}

constexpr std::string_view kBetweenValues = " \t\r\n,";

std::size_t count_values(std::string_view text) noexcept {
  std::size_t count = 0;
  for (std::size_t at = text.find_first_not_of(kBetweenValues); at != std::string_view::npos; ++count)
    at =
        text.find_first_not_of(kBetweenValues, std::min(text.find_first_of(kBetweenValues, at), text.size()));
  return count;
}

/// Returns the basis of a name: as the file states it, or a basis known by the name.
PatchBasis find_basis(const WindowXml& xml, std::string_view name, bool older_half) {
  for (const pugi::xml_node node : xml.layer().child("DataDefinition").children("AngleBasis"))
    if (same_name(trimmed(node.child_value("AngleBasisName")), name)) return stated_basis(xml, node);
  if (same_name(name, "LBNL/Klems Full")) return klems_full_basis();
  if (same_name(name, "LBNL/Klems Half")) return older_half ? klems_older_half_basis() : klems_half_basis();
  if (same_name(name, "LBNL/Klems Quarter")) return klems_quarter_basis();
  xml.fail("an AngleBasis named in DataDefinition", in_quotes(name));
}

std::vector<float> read_values(const WindowXml& reader, std::string_view text, std::size_t count) {
  std::vector<float> values;
  // A value takes at least a digit and a separator.
  values.reserve(std::min(count, text.size() / 2 + 1));
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kBetweenValues), text.size()));
    if (text.empty()) break;
    const std::string_view word = text.substr(0, text.find_first_of(kBetweenValues));
    const auto value = parse_number(word);
    if (!value || std::abs(*value) > std::numeric_limits<float>::max())
      reader.fail("finite numbers in ScatteringData", in_quotes(word));
    if (values.size() == count) reader.fail(fmt::format("{} values in ScatteringData", count), "more");
    values.push_back(static_cast<float>(*value));
    text.remove_prefix(word.size());
  }
  if (values.size() != count)
    reader.fail(fmt::format("{} values in ScatteringData", count), fmt::format("{}", values.size()));
  return values;
}

/// Reads the bases of one block and the matrix between them.
PatchTable read_matrix(const WindowXml& reader, pugi::xml_node block, bool rows) {
  PatchTable table;
  const char *const column = "ColumnAngleBasis", *const row = "RowAngleBasis";
  const char* const text = block.child_value("ScatteringData");
  const std::size_t count = count_values(text);
  for (const bool older_half : {false, true}) {  // the number of values decides
    table.incident = find_basis(reader, trimmed(block.child_value(rows ? row : column)), older_half);
    table.outgoing = find_basis(reader, trimmed(block.child_value(rows ? column : row)), older_half);
    if (table.incident.size() * table.outgoing.size() == count) break;
  }
  // The file numbers incident patches by the direction that the light goes to, wi by the one that it comes from.
  table.incident.first_azimuth = kPi;
  const std::size_t in = table.incident.size(), out = table.outgoing.size();
  table.values = read_values(reader, text, in * out);
  if (rows) {
    const std::vector<float> read = table.values;
    for (std::size_t k = 0; k < read.size(); ++k) table.values[k % out * in + k / out] = read[k];
  }
  return table;
}

/// Converts X, Y and Z to linear Rec. 709.
PatchTable colour_table(const WindowXml& reader, std::span<const PatchTable> xyz) {
  PatchTable table = xyz[0];
  for (const PatchTable& other : xyz)
    if (other.incident != table.incident || other.outgoing != table.outgoing)
      reader.fail("the same bases for CIE-X, CIE-Y and CIE-Z", "others");
  table.channel_count = 3;
  table.values.clear();
  for (std::size_t pair = 0; pair < xyz[0].values.size(); ++pair)
    for (const double value : rec709_of_equal_energy({static_cast<double>(xyz[0].values[pair]),
                                                      static_cast<double>(xyz[1].values[pair]),
                                                      static_cast<double>(xyz[2].values[pair])}))
      table.values.push_back(static_cast<float>(value));
  return table;
}

/// The bases that files of a writer have so far, and their names.
class BasisNames {
 public:
  /// Returns the name of a basis: the known one, or one of its own.
  const std::string& of(PatchBasis basis) {
    basis.first_azimuth = 0;
    const auto found = std::ranges::find(named_, basis, &Named::basis);
    if (found != named_.end()) return found->name;
    const std::pair<PatchBasis, const char*> known[] = {{klems_full_basis(), "LBNL/Klems Full"},
                                                        {klems_half_basis(), "LBNL/Klems Half"},
                                                        {klems_quarter_basis(), "LBNL/Klems Quarter"}};
    std::string name = fmt::format("Patches {}", named_.size() + 1);
    for (const auto& [rings, its_name] : known)
      if (rings == basis) name = its_name;
    return named_.emplace_back(Named{std::move(basis), std::move(name)}).name;
  }
  /// Returns the elements that state every basis.
  std::string definitions() const {
    std::string text;
    for (const auto& [basis, name] : named_) {
      text += fmt::format("<AngleBasis>\n<AngleBasisName>{}</AngleBasisName>\n", name);
      for (const PatchRing& ring : basis.rings)
        text += fmt::format(
            "<AngleBasisBlock><Theta>{}</Theta><nPhis>{}</nPhis><ThetaBounds><LowerTheta>{}</LowerTheta>"
            "<UpperTheta>{}</UpperTheta></ThetaBounds></AngleBasisBlock>\n",
            ring.count == 1 ? 0 : written_degrees((ring.theta_low + ring.theta_high) / 2), ring.count,
            written_degrees(ring.theta_low), written_degrees(ring.theta_high));
      text += "</AngleBasis>\n";
    }
    return text;
  }

 private:
  struct Named {
    PatchBasis basis;
    std::string name;
  };
  std::vector<Named> named_;
};

}  // namespace

bool looks_like_klems(std::string_view text) noexcept {
  return looks_like_window_xml(text);
}

KlemsFile parse_klems(const FileBytes& file, const OpenOptions& options) {
  const WindowXml reader(file);
  const std::string_view structure = reader.structure();
  const bool rows = same_name(structure, "Rows");  // each row is an incident patch
  if (!rows && !same_name(structure, "Columns"))
    reader.fail("IncidentDataStructure Columns or Rows", in_quotes(structure));
  KlemsFile result;
  PatchTable& table = result.table;
  Findings& findings = result.findings;
  const ChosenBlock chosen = reader.choose(options, findings);
  std::vector<PatchTable> channels;
  for (const pugi::xml_node node : chosen.nodes) channels.push_back(read_matrix(reader, node, rows));
  table = channels.size() == 3 ? colour_table(reader, channels) : std::move(channels.front());

  for (const float value : table.values)
    if (value < 0) {
      ++findings.negative_count;
      findings.most_negative = std::min(findings.most_negative, static_cast<double>(value));
    }
  findings.format = "Klems XML";
  findings.description = reader.material();
  findings.conventions.insert(
      findings.conventions.begin(),
      {fmt::format("{}; {} incident; values are f_{} without the cosine.", chosen.sentence,
                   rows ? "rows" : "columns", findings.transmits() ? 't' : 'r'),
       "Incident azimuths are those the light travels to: the mirror direction has the same patch.",
       "Constant over each pair of patches, as Radiance evaluates it."});
  findings.sample_count = table.values.size() / table.channel_count;
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return result;
}

std::string format_klems(std::span<const PatchBlock> blocks, std::string_view material) {
  BasisNames names;
  std::vector<WrittenBlock> written;
  for (const auto& [table, block] : blocks) {
    std::string elements =
        fmt::format("<ColumnAngleBasis>{}</ColumnAngleBasis>\n", names.of(table->incident));
    elements += fmt::format(
        "<RowAngleBasis>{}</RowAngleBasis>\n<ScatteringDataType>{}</ScatteringDataType>\n<ScatteringData>\n",
        names.of(table->outgoing), is_transmission(block.part) ? "BTDF" : "BRDF");
    const std::size_t columns = table->incident.size();
    for (std::size_t k = 0; k < table->values.size(); ++k)
      elements += fmt::format("{}{}", table->values[k], (k + 1) % columns == 0 ? ",\n" : ", ");
    written.push_back({block, elements + "</ScatteringData>\n"});
  }
  return format_window_xml(material, "Columns", names.definitions(), written);
}

}  // namespace burnish
