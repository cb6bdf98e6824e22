// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <burnish/io/part_choice.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxListed = 12;   // most blocks listed as left out
constexpr std::size_t kMaxBlocks = 256;  // most blocks to choose from; no window's file has as many

std::string_view wavelength_of(pugi::xml_node data) {
  return trimmed(data.child_value("Wavelength"));
}

std::string_view direction_of(pugi::xml_node block) {
  return trimmed(block.child_value("WavelengthDataDirection"));
}

/// Returns the part that a file's WavelengthDataDirection names; nothing for other names, such as absorptances.
std::optional<BsdfPart> part_in_direction(std::string_view direction) noexcept {
  for (const BsdfPart part : kBsdfParts)
    if (same_name(direction, window_direction(part))) return part;
  return std::nullopt;
}

/// One block of the file, or the three blocks of CIE-XYZ.
struct FileBlock {
  BsdfBlock block;
  std::vector<pugi::xml_node> nodes;
};

const FileBlock* find_band(const std::vector<FileBlock>& blocks, BsdfPart part, std::string_view band) {
  const auto found = std::ranges::find_if(
      blocks, [&](const FileBlock& b) { return b.block.part == part && same_name(b.block.band, band); });
  return found == blocks.end() ? nullptr : &*found;
}

/// Adds a block of colour for each part that has X, Y and Z.
void add_colours(std::vector<FileBlock>& blocks) {
  for (const BsdfPart part : kBsdfParts) {
    const FileBlock *x = find_band(blocks, part, "CIE-X"), *z = find_band(blocks, part, "CIE-Z"),
                    *y = find_band(blocks, part, "CIE-Y");
    if (!y) y = find_band(blocks, part, "Visible");
    if (x && y && z)
      blocks.push_back({{part, std::string(kColourBand)}, {x->nodes[0], y->nodes[0], z->nodes[0]}});
  }
}

/// Returns the names of blocks outside `taken`, each once: "Transmission Front (Visible)".
std::vector<std::string> other_blocks(pugi::xml_node layer, const std::vector<pugi::xml_node>& taken) {
  std::vector<std::string> others;
  std::size_t more = 0;
  for (const pugi::xml_node data : layer.children("WavelengthData"))
    for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
      if (std::ranges::find(taken, block) != taken.end()) continue;
      std::string name = printable(direction_of(block), 40);
      if (const std::string_view wavelength = wavelength_of(data); !wavelength.empty())
        name += fmt::format(" ({})", printable(wavelength, 40));
      if (std::ranges::find(others, name) != others.end()) continue;
      if (others.size() < kMaxListed)
        others.push_back(std::move(name));
      else
        ++more;
    }
  if (more > 0) others.push_back(fmt::format("{} more blocks", more));
  return others;
}

/// Describes the block that was read: "'Reflection Back', the only reflection there is, visible spectrum".
std::string sentence_of(const std::vector<BsdfBlock>& blocks, const BsdfBlock& taken,
                        const OpenOptions& options) {
  std::string sentence = fmt::format("'{}'", window_direction(taken.part));
  const auto has = [&](const auto& what) { return std::ranges::any_of(blocks, what); };
  if (!options.part && !is_transmission(taken.part) && is_back(taken.part) != options.back_side)
    sentence += ", the only reflection there is";
  if (same_name(taken.band, "Visible"))
    sentence += ", visible spectrum";
  else if (taken.band == kColourBand)
    sentence += ", X, Y and Z under equal energy became linear Rec. 709";
  else if (!taken.band.empty())
    sentence += fmt::format(
        ", {}{}", taken.band,
        has([&](const BsdfBlock& b) { return b.part == taken.part && same_name(b.band, "Visible"); })
            ? ""
            : ", no Visible block");
  return sentence;
}

/// Returns a name as XML content.
std::string escaped(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c == '<')
      text += "&lt;";
    else if (c == '&')
      text += "&amp;";
    else
      text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return text;
}

}  // namespace

std::string_view window_direction(BsdfPart part) noexcept {
  constexpr std::string_view kNames[] = {"Reflection Front", "Reflection Back", "Transmission Front",
                                         "Transmission Back"};
  return kNames[static_cast<std::size_t>(part)];
}

bool looks_like_window_xml(std::string_view text) noexcept {
  const std::size_t first = text.substr(0, 4096).find('<');
  return first != std::string_view::npos &&
         text.substr(first, 4096).find("<WindowElement") != std::string_view::npos;
}

bool same_name(std::string_view a, std::string_view b) noexcept {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

WindowXml::WindowXml(const FileBytes& file) : name_(file.name) {
  const std::size_t first = std::min(file.text().find('<'), file.bytes.size());
  const pugi::xml_parse_result parsed = document_.load_buffer(
      file.bytes.data() + first, file.bytes.size() - first, pugi::parse_default, pugi::encoding_utf8);
  if (!parsed)
    throw Error(name_, first + static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)),
                "well-formed XML", parsed.description());
  layer_ = document_.child("WindowElement").child("Optical").child("Layer");
  if (!layer_) fail("WindowElement/Optical/Layer", "none");
}

void WindowXml::fail(const std::string& expected, const std::string& found) const {
  throw Error::in_file(name_, expected, found);
}

std::string_view WindowXml::structure() const {
  return trimmed(layer_.child("DataDefinition").child_value("IncidentDataStructure"));
}

std::string WindowXml::material() const {
  return printable(trimmed(layer_.child("Material").child_value("Name")), 200);
}

double WindowXml::number(pugi::xml_node node, const char* child) const {
  const std::string_view text = trimmed(node.child_value(child));
  if (const auto value = parse_number(text)) return *value;
  fail(fmt::format("a number in {}", child), in_quotes(text));
}

ChosenBlock WindowXml::choose(const OpenOptions& options, Findings& findings) const {
  std::vector<FileBlock> found;
  std::string present;
  for (const pugi::xml_node data : layer_.children("WavelengthData"))
    for (const pugi::xml_node node : data.children("WavelengthDataBlock")) {
      if (present.size() < 160) present += (present.empty() ? "" : ", ") + in_quotes(direction_of(node));
      const auto part = part_in_direction(direction_of(node));
      const std::string band = printable(wavelength_of(data), 40);
      if (part && found.size() < kMaxBlocks && !find_band(found, *part, band))
        found.push_back({{*part, band}, {node}});
    }
  if (found.empty())
    fail("a WavelengthDataBlock with 'Reflection Front' or another part", present.empty() ? "none" : present);
  add_colours(found);

  std::vector<BsdfBlock> blocks;
  for (const FileBlock& each : found) blocks.push_back(each.block);
  const std::size_t chosen = choose_block(name_, blocks, options);
  note_blocks(blocks, chosen, options, findings);
  findings.left_out = other_blocks(layer_, found[chosen].nodes);
  return {.nodes = found[chosen].nodes, .sentence = sentence_of(blocks, blocks[chosen], options)};
}

std::string format_window_xml(std::string_view material, std::string_view structure,
                              std::string_view definitions, std::span<const WrittenBlock> blocks) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<WindowElement xmlns=\"http://windows.lbl.gov\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n"
      "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n<Optical>\n<Layer>\n"
      "<Material>\n<Name>{}</Name>\n<Manufacturer>unknown</Manufacturer>\n<DeviceType>Other</DeviceType>\n"
      "</Material>\n<DataDefinition>\n<IncidentDataStructure>{}</IncidentDataStructure>\n{}"
      "</DataDefinition>\n",
      escaped(material), structure, definitions);
  for (const auto& [block, elements] : blocks)
    text += fmt::format(
        "<WavelengthData>\n<LayerNumber>System</LayerNumber>\n"
        "<Wavelength unit=\"Integral\">{}</Wavelength>\n<WavelengthDataBlock>\n"
        "<WavelengthDataDirection>{}</WavelengthDataDirection>\n{}</WavelengthDataBlock>\n</"
        "WavelengthData>\n",
        escaped(block.band.empty() ? "Visible" : block.band), window_direction(block.part), elements);
  return text + "</Layer>\n</Optical>\n</WindowElement>\n";
}

}  // namespace burnish
