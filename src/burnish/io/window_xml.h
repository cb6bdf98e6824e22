#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// True if the text has an XML element WindowElement near its start. Text in front of the first '<' is none of it:
/// genBSDF writes a line there.
bool looks_like_window_xml(std::string_view text) noexcept;

/// Whether two names are one: files and programs write them in any case.
bool same_name(std::string_view a, std::string_view b) noexcept;

/// The name of a part in such files: "Reflection Front".
std::string_view window_direction(BsdfPart part) noexcept;

/// The band of three channels that CIE-X, CIE-Y or Visible, and CIE-Z make.
inline constexpr std::string_view kColourBand = "CIE-XYZ";

/// One part and band of a window system's file.
struct ChosenBlock {
  /// Its WavelengthDataBlock; of the band CIE-XYZ those of X, Y and Z, where a file without CIE-Y has Visible for Y.
  std::vector<pugi::xml_node> nodes;
  std::string sentence;  ///< what was taken and why, without a full stop
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
  /// The block that the options ask for, as choose_block does, and the findings that say so: blocks, block, left_out.
  /// Three blocks of a part in CIE-X, CIE-Y or Visible, and CIE-Z are another band, CIE-XYZ, of three channels. Throws
  /// Error, naming what is present, if there is no such block.
  ChosenBlock choose(const OpenOptions& options, Findings& findings) const;

 private:
  std::string name_;
  pugi::xml_document document_;
  pugi::xml_node layer_;
};

}  // namespace burnish
