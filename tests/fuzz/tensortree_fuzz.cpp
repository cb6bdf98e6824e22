// SPDX-License-Identifier: Apache-2.0
#include <burnish/io/tensor_tree_xml.h>

#include "fuzz_reader.h"

// A parsed tree is written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions& options) {
    const burnish::TensorTree tree = burnish::parse_tensor_tree(file, options).table;
    burnish::check(tree);
    const std::string text = burnish::format_tensor_tree(tree, "fuzzed");
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    if (burnish::parse_tensor_tree({"again", {bytes, bytes + text.size()}}, {}).table.values != tree.values)
      __builtin_trap();
  });
}
