#include <algorithm>

#include <fmt/format.h>

#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>

namespace burnish {

WindowXml::WindowXml(const FileBytes& file) : name_(file.name) {
  const pugi::xml_parse_result parsed =
      document_.load_buffer(file.bytes.data(), file.bytes.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed)
    throw Error(name_, static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)),
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

pugi::xml_node WindowXml::find_block(std::string_view direction) const {
  pugi::xml_node found;
  for (const pugi::xml_node data : layer_.children("WavelengthData"))
    for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
      const bool visible = trimmed(data.child_value("Wavelength")) == "Visible";
      if (trimmed(block.child_value("WavelengthDataDirection")) == direction && (!found || visible))
        found = block;
    }
  return found;
}

pugi::xml_node WindowXml::block(std::string_view direction) const {
  if (const pugi::xml_node found = find_block(direction)) return found;
  std::string present;
  for (const pugi::xml_node data : layer_.children("WavelengthData"))
    for (const pugi::xml_node block : data.children("WavelengthDataBlock"))
      if (present.size() < 160)
        present +=
            (present.empty() ? "" : ", ") + in_quotes(trimmed(block.child_value("WavelengthDataDirection")));
  fail(fmt::format("a WavelengthDataBlock '{}'", direction), present.empty() ? "none" : present);
}

}  // namespace burnish
