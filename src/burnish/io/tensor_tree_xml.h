#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/function_brdf.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {

struct TensorTreeFile {
  TensorTree table;                ///< of the band CIE-XYZ that of X
  std::vector<TensorTree> colour;  ///< of the band CIE-XYZ those of Y and Z; empty otherwise
  Findings findings;
};

/// True if the text is XML with a WindowElement that names a TensorTree within its first 64 KiB.
bool looks_like_tensor_tree(std::string_view text) noexcept;

/// One tree of a window system's XML file, TensorTree3 or TensorTree4: the part and band that the options ask for, see
/// choose_block (Radiance calls the front Back). Braces hold 2^rank braces, or 2^(rank k) values. Grey, as constant as
/// Radiance has it; three trees of the band CIE-XYZ, see colour_of. Throws Error if there is no such tree, its basis is
/// not LBNL/Shirley-Chiu, braces or counts do not fit, a tree is deeper than 24, or a value is no float.
/// Checked against load_tree_data and SDqueryTre of Radiance's bsdf_t.c, and a tree of rank 3 that its bsdf2ttree
/// wrote; values of all four parts against Radiance's (tests/bsdf). Source: [Ward 2012].
TensorTreeFile parse_tensor_tree(const FileBytes& file, const OpenOptions& options);

/// Trees of X, Y and Z as one function in linear Rec. 709, values below zero cut. Precondition: file.colour has two.
FunctionBrdf colour_of(TensorTreeFile file);

/// The file that holds the tree as one block, by default "Reflection Back" (Radiance's front) of the visible spectrum:
/// reading it gives the same tree, every value to its last bit.
std::string format_tensor_tree(const TensorTree& tree, std::string_view material,
                               const BsdfBlock& block = {BsdfPart::reflection_back, "Visible"});

}  // namespace burnish
