// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// Returns true if the text has an XML element WindowElement near its start. Text in front of the first '<' is
/// ignored, because genBSDF writes a line there.
bool looks_like_window_xml(std::string_view text) noexcept;

/// Returns true if two names are equal in any case, since files and programs differ in it.
bool same_name(std::string_view a, std::string_view b) noexcept;

/// Returns the name of a part in window systems' files: "Reflection Front".
std::string_view window_direction(BsdfPart part) noexcept;

/// The band whose three channels are CIE-X, CIE-Y or Visible, and CIE-Z.
inline constexpr std::string_view kColourBand = "CIE-XYZ";

/// One part and band of a window system's file.
struct ChosenBlock {
  /// The block's WavelengthDataBlock. The band CIE-XYZ has those of X, Y and Z; in a file without CIE-Y, Visible
  /// stands for Y.
  std::vector<pugi::xml_node> nodes;
  std::string sentence;  ///< the block that was read and the reason, without a full stop
};

/// The XML file of a window system; every error names the file.
class WindowXml {
 public:
  /// Throws Error unless the text is well-formed and has a WindowElement/Optical/Layer.
  explicit WindowXml(const FileBytes& file);

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  pugi::xml_node layer() const { return layer_; }
  /// Return IncidentDataStructure, and the name of the material.
  std::string_view structure() const;
  std::string material() const;
  /// Returns the number that is a child's content. Throws Error if it is none.
  double number(pugi::xml_node node, const char* child) const;
  /// Returns the block that choose_block finds for the options, and fills in the findings about it: blocks, block,
  /// left_out. Three blocks of a part in CIE-X, CIE-Y or Visible, and CIE-Z make another band, CIE-XYZ, of three
  /// channels. Throws Error, naming the blocks of the file, if there is no such block.
  ChosenBlock choose(const OpenOptions& options, Findings& findings) const;

 private:
  std::string name_;
  pugi::xml_document document_;
  pugi::xml_node layer_;
};

/// One block of a file to write: its part and band, and the elements between the direction and the block's end.
struct WrittenBlock {
  BsdfBlock block;
  std::string elements;
};

/// Returns a window system's file: the material's name, IncidentDataStructure, what else stands in DataDefinition, and
/// the blocks. Bands without a name are Visible.
std::string format_window_xml(std::string_view material, std::string_view structure,
                              std::string_view definitions, std::span<const WrittenBlock> blocks);

}  // namespace burnish
