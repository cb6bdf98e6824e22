// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/factors/model_spec.h>

namespace burnish {

/// The numbers of a table's nodes among the unknowns of a system: copy c of node n is number base + n copies + c.
struct NodeNumbers {
  std::size_t base = 0;
  std::size_t copies = 1;  ///< one for all channels, or one each and what pads them

  std::size_t operator()(std::size_t node, std::size_t channel) const noexcept {
    return base + node * copies + (copies > 1 ? channel : 0);
  }
};

/// The unknowns of a system, table by table.
struct Numbering {
  std::vector<NodeNumbers> tables;
  std::size_t count = 0;
};

/// Numbers a model's nodes, `copies` of each; one of tables that the channels share.
Numbering number_nodes(const ModelSpec& spec, std::size_t copies);

/// Unknowns that are solved together: those of one channel, or of all where a table is shared by them.
std::size_t coupled_unknowns(const ModelSpec& spec, std::size_t channels);

}  // namespace burnish
