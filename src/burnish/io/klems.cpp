#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <burnish/io/klems.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxPatches = 4096;

/// Reads parts of the document; every complaint names the file.
class KlemsReader {
 public:
  explicit KlemsReader(const FileBytes& file) : name_(file.name) {
    const pugi::xml_parse_result parsed =
        document_.load_buffer(file.bytes.data(), file.bytes.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed)
      throw Error(name_, static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)),
                  "well-formed XML", parsed.description());
    layer_ = document_.child("WindowElement").child("Optical").child("Layer");
    if (!layer_) fail("WindowElement/Optical/Layer", "none");
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw Error::in_file(name_, expected, found);
  }

  pugi::xml_node layer() const { return layer_; }

  double number(pugi::xml_node node, const char* child) const {
    const std::string_view text = trimmed(node.child_value(child));
    if (const auto value = parse_number(text)) return *value;
    fail(fmt::format("a number in {}", child), in_quotes(text));
  }

  PatchBasis basis(std::string_view name) const {
    for (const pugi::xml_node node : layer_.child("DataDefinition").children("AngleBasis"))
      if (trimmed(node.child_value("AngleBasisName")) == name) return stated_basis(node);
    if (name == "LBNL/Klems Full") return klems_full_basis();
    fail("an AngleBasis named in DataDefinition", in_quotes(name));
  }

 private:
  PatchBasis stated_basis(pugi::xml_node node) const {
    PatchBasis basis;
    double last_deg = 0;
    for (const pugi::xml_node block : node.children("AngleBasisBlock")) {
      const pugi::xml_node bounds = block.child("ThetaBounds");
      const double low_deg = number(bounds, "LowerTheta"), high_deg = number(bounds, "UpperTheta"),
                   count = number(block, "nPhis");
      if (low_deg != last_deg || !(high_deg > low_deg && high_deg <= 90))
        fail("rings that follow each other from 0 to 90 degrees",
             fmt::format("{} ... {}", low_deg, high_deg));
      if (count != std::floor(count) ||
          !(count >= 1 && count + static_cast<double>(basis.size()) <= kMaxPatches))
        fail(fmt::format("at most {} patches", kMaxPatches), fmt::format("a ring of {}", count));
      basis.rings.push_back(
          {radians(low_deg), radians(high_deg), static_cast<std::size_t>(count), basis.size()});
      last_deg = high_deg;
    }
    if (last_deg != 90) fail("an AngleBasis up to 90 degrees", fmt::format("{} degrees", last_deg));
    return basis;
  }

  std::string name_;
  pugi::xml_document document_;
  pugi::xml_node layer_;
};

/// The matrix of one direction; the visible one goes before the others.
pugi::xml_node find_matrix(const KlemsReader& reader, std::string_view direction) {
  pugi::xml_node found;
  std::string present;
  for (const pugi::xml_node data : reader.layer().children("WavelengthData"))
    for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
      const std::string_view name = trimmed(block.child_value("WavelengthDataDirection"));
      if (present.size() < 200) present += (present.empty() ? "" : ", ") + in_quotes(name);
      const bool visible = trimmed(data.child_value("Wavelength")) == "Visible";
      if (name == direction && (!found || visible)) found = block;
    }
  if (!found)
    reader.fail(fmt::format("a WavelengthDataBlock '{}'", direction), present.empty() ? "none" : present);
  return found;
}

std::vector<float> read_values(const KlemsReader& reader, std::string_view text, std::size_t count) {
  constexpr std::string_view separators = " \t\r\n,";
  std::vector<float> values;
  // a value takes a digit and a separator
  values.reserve(std::min(count, text.size() / 2 + 1));
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
    if (text.empty()) break;
    const std::string_view word = text.substr(0, text.find_first_of(separators));
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

}  // namespace

bool looks_like_klems(std::string_view text) noexcept {
  const std::string_view start = text.substr(0, 4096);
  const std::size_t first = start.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && start[first] == '<' &&
         start.find("<WindowElement") != std::string_view::npos;
}

KlemsFile parse_klems(const FileBytes& file, const OpenOptions& options) {
  const KlemsReader reader(file);
  const std::string_view structure =
      trimmed(reader.layer().child("DataDefinition").child_value("IncidentDataStructure"));
  if (structure != "Columns") reader.fail("IncidentDataStructure Columns", in_quotes(structure));
  const std::string_view direction = options.back_side ? "Reflection Back" : "Reflection Front";
  const pugi::xml_node block = find_matrix(reader, direction);

  // the bases and the matrix between them
  KlemsFile result;
  PatchTable& table = result.table;
  Findings& findings = result.findings;
  table.incident = reader.basis(trimmed(block.child_value("ColumnAngleBasis")));
  // the file counts incident patches by where the light goes to, wi by where it comes from.
  table.incident.first_azimuth = kPi;
  table.outgoing = reader.basis(trimmed(block.child_value("RowAngleBasis")));
  table.values =
      read_values(reader, block.child_value("ScatteringData"), table.incident.size() * table.outgoing.size());
  for (const float value : table.values)
    if (value < 0) {
      ++findings.negative_count;
      findings.most_negative = std::min(findings.most_negative, static_cast<double>(value));
    }
  findings.format = "Klems XML";
  findings.description = printable(trimmed(reader.layer().child("Material").child_value("Name")), 200);
  findings.conventions = {
      fmt::format("'{}', columns incident; values are f_r without the cosine.", direction),
      "Incident azimuths are those the light travels to: the mirror direction has the same patch.",
      "Patch averages stand for the patch centres; linear between them, periodic in azimuth."};
  findings.sample_count = table.values.size();
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return result;
}

}  // namespace burnish
