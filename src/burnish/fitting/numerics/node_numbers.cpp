// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <burnish/fitting/numerics/node_numbers.h>

namespace burnish {

Numbering number_nodes(const ModelSpec& spec, std::size_t copies) {
  Numbering numbering;
  for (const ModelSpec::TableSpec& table : spec.tables) {
    numbering.tables.push_back({.base = numbering.count, .copies = table.shared ? 1 : copies});
    numbering.count += table.layout.node_count() * numbering.tables.back().copies;
  }
  return numbering;
}

std::size_t coupled_unknowns(const ModelSpec& spec, std::size_t channels) {
  const bool coupled = std::ranges::any_of(spec.tables, &ModelSpec::TableSpec::shared);
  return number_nodes(spec, coupled ? channels : 1).count;
}

}  // namespace burnish
