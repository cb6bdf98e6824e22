#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <burnish/io/byte_reader.h>

namespace burnish {

/// True if the text has an XML element WindowElement near its start. Text in front of the first '<' is none of it:
/// genBSDF writes a line there.
bool looks_like_window_xml(std::string_view text) noexcept;

/// Whether two names are one: files and programs write them in any case.
bool same_name(std::string_view a, std::string_view b) noexcept;

/// One reflection of a window system's file.
struct ReflectionBlock {
  pugi::xml_node node;
  std::string side;                   ///< "Reflection Front" or "Reflection Back"
  std::string sentence;               ///< what was taken and why, without a full stop
  std::vector<std::string> left_out;  ///< the other blocks: "Transmission Front (Visible)"
};

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
  /// The WavelengthDataBlock of "Reflection Front", or of "Reflection Back" if asked; the other's where the file has
  /// that one alone. That of the visible spectrum comes before others. Throws Error, naming what is present, if there
  /// is no reflection.
  ReflectionBlock reflection(bool back) const;

 private:
  std::string name_;
  pugi::xml_document document_;
  pugi::xml_node layer_;
};

}  // namespace burnish
