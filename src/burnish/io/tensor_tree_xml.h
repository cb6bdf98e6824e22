#pragma once

#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {

struct TensorTreeFile {
  TensorTree table;
  Findings findings;
};

/// True if the text is XML with a WindowElement that names a TensorTree within its first 64 KiB.
bool looks_like_tensor_tree(std::string_view text) noexcept;

/// The reflection tree of a window system's XML file, TensorTree3 or TensorTree4: "Reflection Front", or "Reflection
/// Back" if asked, the other where a file has that one alone, as files of one surface do (Radiance calls the front
/// Back); of the visible spectrum where there are several. Braces hold 2^rank braces, or 2^(rank k) values. Grey, as
/// constant as Radiance has it. Throws Error if there is no such tree, its basis is not LBNL/Shirley-Chiu, braces or
/// counts do not fit, a tree is deeper than 24, or a value is no float.
/// Checked against load_tree_data and SDqueryTre of Radiance's bsdf_t.c, and a tree of rank 3 that its bsdf2ttree
/// wrote. Source: [Ward 2012].
TensorTreeFile parse_tensor_tree(const FileBytes& file, const OpenOptions& options);

/// The file that holds the tree as one reflection, "Reflection Back" (Radiance's front) unless the tree came from the
/// other: reading it gives the same tree, every value to its last bit.
std::string format_tensor_tree(const TensorTree& tree, std::string_view material,
                               std::string_view side = "Reflection Back");

}  // namespace burnish
