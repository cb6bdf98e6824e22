// SPDX-License-Identifier: Apache-2.0
#include <burnish/baselines/evaluation_cost.h>

namespace burnish {

namespace {

// One lookup of every channel and term of a table: 2^axes corners.
EvaluationCost lookup_cost(const NodeTable& table) noexcept {
  const std::size_t reads =
      (std::size_t{1} << table.axes.size()) * table.channels * static_cast<std::size_t>(table.terms);
  return {reads, reads};
}

EvaluationCost& operator+=(EvaluationCost& sum, const EvaluationCost& more) noexcept {
  sum.table_reads += more.table_reads;
  sum.multiplies += more.multiplies;
  return sum;
}

}  // namespace

EvaluationCost evaluation_cost(const FactoredBrdf& brdf) noexcept {
  EvaluationCost cost;
  for (const Lobe& lobe : brdf.lobes())
    for (const FactorUse& use : lobe.factors) {
      const Table& table = brdf.table_of(use);
      const std::size_t corners = std::size_t{1} << axis_count(table.layout.shape);
      const std::size_t reads = corners * table.channels;
      cost += {reads, reads + brdf.channels()};  // into the product with the scale
    }
  return cost;
}

EvaluationCost evaluation_cost(const SeparableBrdf& brdf) noexcept {
  EvaluationCost cost = lookup_cost(brdf.u());
  cost += lookup_cost(brdf.v());
  cost.multiplies += brdf.channels() * static_cast<std::size_t>(brdf.u().terms + 1);
  return cost;
}

EvaluationCost evaluation_cost(const DgfBrdf& brdf) noexcept {
  EvaluationCost cost = lookup_cost(brdf.d());
  cost += lookup_cost(brdf.f());
  cost += lookup_cost(brdf.g());
  cost += lookup_cost(brdf.g());
  cost.multiplies += 4 * brdf.channels();  // D F G G scale
  return cost;
}

EvaluationCost evaluation_cost(const NeuralBrdf&) noexcept {
  return {NeuralBrdf::kWeights, NeuralBrdf::kWeights - 2 * NeuralBrdf::kHidden - NeuralBrdf::kOutputs};
}

EvaluationCost evaluation_cost(const NpBrdf&) noexcept {
  return {NpDecoder::kWeights, NpDecoder::kProducts};
}

std::optional<EvaluationCost> evaluation_cost(const BaselineBrdf& brdf) noexcept {
  if (const auto* separable = std::get_if<SeparableBrdf>(&brdf)) return evaluation_cost(*separable);
  if (const auto* dgf = std::get_if<DgfBrdf>(&brdf)) return evaluation_cost(*dgf);
  return std::nullopt;
}

}  // namespace burnish
