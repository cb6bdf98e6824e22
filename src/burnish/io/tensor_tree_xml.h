// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
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
  TensorTree table;                ///< in the band CIE-XYZ the tree of X
  std::vector<TensorTree> colour;  ///< in the band CIE-XYZ the trees of Y and Z; otherwise empty
  Findings findings;
};

/// Returns true if the text is XML with a WindowElement that names a TensorTree within its first 64 KiB.
bool looks_like_tensor_tree(std::string_view text) noexcept;

/// Reads one tree of a window system's XML file, TensorTree3 or TensorTree4: the part and band that choose_block finds
/// for the options (Radiance calls the front Back). Braces hold 2^rank braces, or 2^(rank k) values. The tree is grey
/// and constant within its cubes, as in Radiance; the band CIE-XYZ has three trees, see colour_of.
///
/// Throws Error if there is no such tree or its basis is not LBNL/Shirley-Chiu. Throws Error if braces or counts do
/// not fit, a tree is deeper than 24, or a value is no float. The reader was checked against load_tree_data and
/// SDqueryTre of Radiance's bsdf_t.c, and a tree of rank 3 that its bsdf2ttree wrote. Values of all four parts were
/// checked against Radiance's (tests/bsdf). Source: [Ward 2012].
TensorTreeFile parse_tensor_tree(const FileBytes& file, const OpenOptions& options);

/// Joins the trees of X, Y and Z into one function in linear Rec. 709, values below zero cut. Precondition:
/// file.colour has two trees.
FunctionBrdf colour_of(TensorTreeFile file);

/// Returns the file that holds the tree as one block, by default "Reflection Back" (Radiance's front) of the visible
/// spectrum. Reading it back gives the same tree, every value to its last bit.
std::string format_tensor_tree(const TensorTree& tree, std::string_view material,
                               const BsdfBlock& block = {BsdfPart::reflection_back, "Visible"});

/// A tree and the block that it becomes.
struct TreeBlock {
  const TensorTree* tree;
  BsdfBlock block;
};

/// Returns the file that holds several trees. Precondition: there is one. Throws Error if their ranks differ.
std::string format_tensor_trees(std::span<const TreeBlock> trees, std::string_view material);

}  // namespace burnish
