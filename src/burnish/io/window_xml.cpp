#include <algorithm>

#include <fmt/format.h>

#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxListed = 12;  // blocks that are named as left out

std::string_view wavelength_of(pugi::xml_node data) {
  return trimmed(data.child_value("Wavelength"));
}

std::string_view direction_of(pugi::xml_node block) {
  return trimmed(block.child_value("WavelengthDataDirection"));
}

/// The visible spectrum first, then what says nothing, then others.
int rank_of(pugi::xml_node data) {
  const std::string_view wavelength = wavelength_of(data);
  return same_name(wavelength, "Visible") ? 0
         : same_name(wavelength, "CIE-Y") ? 1
         : wavelength.empty()             ? 2
                                          : 3;
}

}  // namespace

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

ReflectionBlock WindowXml::reflection(bool back) const {
  const std::string_view asked = back ? "Reflection Back" : "Reflection Front",
                         other = back ? "Reflection Front" : "Reflection Back";
  pugi::xml_node found_data;
  ReflectionBlock found;
  for (const std::string_view direction : {asked, other}) {
    for (const pugi::xml_node data : layer_.children("WavelengthData"))
      for (const pugi::xml_node block : data.children("WavelengthDataBlock"))
        if (same_name(direction_of(block), direction) &&
            (!found_data || rank_of(data) < rank_of(found_data))) {
          found_data = data;
          found.node = block;
        }
    if (!found.node) continue;
    found.side = direction;
    break;
  }

  // what else there is
  std::string present;
  std::size_t more = 0;
  for (const pugi::xml_node data : layer_.children("WavelengthData"))
    for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
      if (present.size() < 160) present += (present.empty() ? "" : ", ") + in_quotes(direction_of(block));
      if (block == found.node) continue;
      const std::string_view wavelength = wavelength_of(data);
      std::string name = printable(direction_of(block), 40);
      if (!wavelength.empty()) name += fmt::format(" ({})", printable(wavelength, 40));
      if (std::find(found.left_out.begin(), found.left_out.end(), name) != found.left_out.end()) continue;
      if (found.left_out.size() < kMaxListed)
        found.left_out.push_back(std::move(name));
      else
        ++more;
    }
  if (!found.node) fail(fmt::format("a WavelengthDataBlock '{}'", asked), present.empty() ? "none" : present);
  if (more > 0) found.left_out.push_back(fmt::format("{} more blocks", more));

  found.sentence = fmt::format("'{}'", found.side);
  if (found.side != asked) found.sentence += ", the only reflection there is";
  if (const int rank = rank_of(found_data); rank == 0)
    found.sentence += ", visible spectrum";
  else if (rank != 2)
    found.sentence += fmt::format(", {}, no Visible block", printable(wavelength_of(found_data), 40));
  return found;
}

}  // namespace burnish
