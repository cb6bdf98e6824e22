// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// The places of a model's lookups, the same for every channel. Lobes that look up the same texels, and the same
/// texels of a table that they share, have one lookup. Tables of one layout that are looked up alike have one place.
struct Lookups {
  struct Place {
    std::uint32_t node;
    float fx, fy, fz;
  };
  std::vector<FactorUse> lookups;               ///< distinct
  std::vector<std::vector<std::size_t>> lobes;  ///< the lookups of each lobe's factors
  std::vector<std::size_t> place_of;            ///< each lookup's place
  std::size_t place_count = 0;

  /// Pairs follow each other in blocks of this many.
  static constexpr std::size_t kBlock = 32;
  /// Blocks that one thread takes at a time.
  static constexpr std::size_t kBlocksATask = 64;
  std::size_t pairs = 0;
  std::vector<Place> places;  ///< [pair / kBlock][place][pair % kBlock]

  /// The set's weights of lobes, [pair][lobe], as many pairs as the blocks have; empty: 1.
  std::vector<float> lobe_weights;
};

Lookups lookups_of(const ModelSpec& spec, const TrainingSet& set);

/// Returns the set with pixels and other pairs each in the order of the cells of the model's largest tables that they
/// fall on: neighbours read and add to the same nodes.
TrainingSet ordered_by_cells(const TrainingSet& set, const ModelSpec& spec);

}  // namespace burnish
