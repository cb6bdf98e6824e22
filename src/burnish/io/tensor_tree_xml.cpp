// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include <fmt/format.h>

#include <burnish/io/tensor_tree_xml.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>
#include <burnish/math/angles.h>
#include <burnish/math/spectrum.h>

namespace burnish {

namespace {

constexpr std::string_view kBlanks = " \t\r\n,";
constexpr int kMaxDepth = 24;

/// Reads the braces of ScatteringData.
class BraceReader {
 public:
  BraceReader(const WindowXml& xml, std::string_view text, int rank)
      : xml_(xml), text_(text), children_(std::size_t{1} << rank) {
    tree_.rank = rank;
  }

  TensorTree read() {
    add_node(0);
    skip_blanks();
    if (!text_.empty()) xml_.fail("the end of ScatteringData after its tree", in_quotes(text_));
    return std::move(tree_);
  }

 private:
  void skip_blanks() noexcept {
    text_.remove_prefix(std::min(text_.find_first_not_of(kBlanks), text_.size()));
  }

  bool at(char c) noexcept {
    skip_blanks();
    return text_.starts_with(c);
  }

  void eat(char c) {
    if (!at(c)) xml_.fail(fmt::format("'{}' in ScatteringData", c), in_quotes(text_.substr(0, 20)));
    text_.remove_prefix(1);
  }

  std::uint32_t add_node(int depth) {
    if (depth > kMaxDepth) xml_.fail(fmt::format("a tree of at most {} levels", kMaxDepth), "a deeper one");
    const auto number = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    eat('{');
    if (at('{')) {
      // The links of a branch stand together; its nodes need not.
      const std::size_t first = tree_.links.size();
      tree_.nodes[number].first = static_cast<std::uint32_t>(first);
      tree_.links.resize(first + children_);
      for (std::size_t child = 0; child < children_; ++child) {
        const std::uint32_t added = add_node(depth + 1);
        tree_.links[first + child] = added;
      }
    } else {
      tree_.nodes[number] = read_values();
    }
    eat('}');
    return number;
  }

  TensorTree::Node read_values() {
    const std::size_t first = tree_.values.size();
    while (!at('}')) {
      const std::string_view word = text_.substr(0, text_.find_first_of(" \t\r\n,{}"));
      const auto value = parse_number(word);
      if (!value || std::abs(*value) > std::numeric_limits<float>::max())
        xml_.fail("finite numbers in ScatteringData", in_quotes(word));
      tree_.values.push_back(static_cast<float>(*value));
      text_.remove_prefix(word.size());
    }
    const std::size_t count = tree_.values.size() - first;
    int log2 = 0;
    while (std::size_t{1} << tree_.rank * log2 < count) ++log2;
    if (std::size_t{1} << tree_.rank * log2 != count)
      xml_.fail(fmt::format("2^({} k) values between braces", tree_.rank), fmt::format("{}", count));
    return {log2, static_cast<std::uint32_t>(first)};
  }

  const WindowXml& xml_;
  std::string_view text_;
  const std::size_t children_;
  TensorTree tree_;
};

void add_braces(const TensorTree& tree, std::size_t index, std::string& text) {
  const TensorTree::Node node = tree.nodes[index];
  text += '{';
  if (node.log2 < 0)
    for (std::size_t child = 0; child < std::size_t{1} << tree.rank; ++child)
      add_braces(tree, tree.links[node.first + child], text);
  else
    for (std::size_t i = 0; i < std::size_t{1} << tree.rank * node.log2; ++i)
      text += fmt::format(" {}", tree.values[node.first + i]);
  text += " }\n";
}

}  // namespace

bool looks_like_tensor_tree(std::string_view text) noexcept {
  return looks_like_window_xml(text) &&
         lower_case(text.substr(0, 65536)).find("tensortree") != std::string::npos;
}

TensorTreeFile parse_tensor_tree(const FileBytes& file, const OpenOptions& options) {
  const WindowXml xml(file);
  const std::string_view structure = xml.structure();
  const bool rank_3 = same_name(structure, "TensorTree3");
  if (!rank_3 && !same_name(structure, "TensorTree4"))
    xml.fail("IncidentDataStructure TensorTree3 or TensorTree4", in_quotes(structure));

  TensorTreeFile result;
  Findings& findings = result.findings;
  const ChosenBlock chosen = xml.choose(options, findings);
  std::vector<TensorTree> trees;
  for (const pugi::xml_node block : chosen.nodes) {
    if (const std::string_view basis = trimmed(block.child_value("AngleBasis"));
        !same_name(basis, "LBNL/Shirley-Chiu"))
      xml.fail("AngleBasis LBNL/Shirley-Chiu", in_quotes(basis));
    trees.push_back(BraceReader(xml, block.child_value("ScatteringData"), rank_3 ? 3 : 4).read());
  }
  for (const TensorTree& tree : trees)
    for (const TreeLeaf& leaf : leaves(tree)) {
      findings.sample_count += &tree == trees.data();
      findings.negative_count += leaf.value < 0;
      findings.most_negative = std::min(findings.most_negative, static_cast<double>(leaf.value));
    }
  result.table = std::move(trees.front());
  result.colour.assign(std::make_move_iterator(trees.begin() + 1), std::make_move_iterator(trees.end()));

  findings.format = fmt::format("tensor tree XML of rank {}", rank_3 ? 3 : 4);
  findings.description = xml.material();
  findings.conventions.insert(
      findings.conventions.begin(),
      {fmt::format("{}; values are f_{} without the cosine.", chosen.sentence,
                   findings.transmits() ? 't' : 'r'),
       "Incident directions are those the light travels to: the mirror direction has the same place.",
       "Constant over each cube, as Radiance evaluates it."});
  if (rank_3) findings.conventions.push_back("Isotropic.");
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return result;
}

FunctionBrdf colour_of(TensorTreeFile file) {
  std::vector<TensorTree> xyz = std::move(file.colour);
  xyz.insert(xyz.begin(), std::move(file.table));
  const bool isotropic = xyz[0].isotropic();
  return {3, isotropic,
          [xyz = std::move(xyz)](std::span<const DirectionPair> pairs, std::span<double> values) {
            for (std::size_t i = 0; i < pairs.size(); ++i) {
              std::array<double, 3> f;
              for (std::size_t c = 0; c < 3; ++c) xyz[c].eval_raw(pairs[i].wi, pairs[i].wo, {&f[c], 1});
              std::ranges::copy(rec709_of_equal_energy(f), &values[3 * i]);
            }
            cut_negatives(values);
          }};
}

std::string format_tensor_tree(const TensorTree& tree, std::string_view material, const BsdfBlock& block) {
  const TreeBlock only{&tree, block};
  return format_tensor_trees({&only, 1}, material);
}

std::string format_tensor_trees(std::span<const TreeBlock> trees, std::string_view material) {
  std::vector<WrittenBlock> blocks;
  for (const auto& [tree, block] : trees) {
    if (tree->rank != trees.front().tree->rank)
      throw Error("tensor trees of one file: expected one rank, found 3 and 4");
    std::string braces;
    add_braces(*tree, 0, braces);
    blocks.push_back({block, fmt::format("<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n"
                                         "<ScatteringDataType>BTDF</ScatteringDataType>\n"
                                         "<ScatteringData>\n{}</ScatteringData>\n",
                                         braces)});
  }
  return format_window_xml(material, fmt::format("TensorTree{}", trees.front().tree->rank), "", blocks);
}

}  // namespace burnish
