#pragma once

#include <string>
#include <string_view>

#include <pugixml.hpp>

#include <burnish/io/byte_reader.h>

namespace burnish {

/// The XML file of a window system; every complaint names the file.
class WindowXml {
 public:
  /// Throws Error unless the text is well-formed and has a WindowElement/Optical/Layer.
  explicit WindowXml(const FileBytes& file);

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  pugi::xml_node layer() const { return layer_; }
  /// IncidentDataStructure, and the name of the material.
  std::string_view structure() const;
  std::string material() const;
  /// The number that is a child's content. Throws Error if it is none.
  double number(pugi::xml_node node, const char* child) const;
  /// The WavelengthDataBlock of a direction such as "Reflection Front", that of the visible spectrum before others;
  /// no node if there is none.
  pugi::xml_node find_block(std::string_view direction) const;
  /// The same; throws Error, naming what is present, if there is none.
  pugi::xml_node block(std::string_view direction) const;

 private:
  std::string name_;
  pugi::xml_document document_;
  pugi::xml_node layer_;
};

}  // namespace burnish
