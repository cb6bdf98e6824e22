// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <burnish/baselines/baseline_file.h>
#include <burnish/baselines/neural_brdf.h>
#include <burnish/baselines/np_brdf.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// The work of one evaluation on stored numbers, all channels together: numbers read, and multiplications that
/// interpolate and combine them. Finding the place in a table is not counted.
struct EvaluationCost {
  std::size_t table_reads = 0, multiplies = 0;

  friend bool operator==(const EvaluationCost&, const EvaluationCost&) = default;
};

EvaluationCost evaluation_cost(const FactoredBrdf& brdf) noexcept;
EvaluationCost evaluation_cost(const SeparableBrdf& brdf) noexcept;
EvaluationCost evaluation_cost(const DgfBrdf& brdf) noexcept;
/// Their weights are read and all but the biases multiplied; of NpBrdf those of the decoder.
EvaluationCost evaluation_cost(const NeuralBrdf& brdf) noexcept;
EvaluationCost evaluation_cost(const NpBrdf& brdf) noexcept;
/// Nothing for analytic models, which are no tables.
std::optional<EvaluationCost> evaluation_cost(const BaselineBrdf& brdf) noexcept;

}  // namespace burnish
