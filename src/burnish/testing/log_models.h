// SPDX-License-Identifier: Apache-2.0
#pragma once

// Helpers of the tests of refinement: small sets, random models and their values.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/fitting/refinement/log_model.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>

namespace burnish::fixtures {

constexpr std::size_t kHalfRgb = 6;  ///< bytes of a texel

inline TrainingSet small_set(const AnalyticBrdf& brdf, std::size_t count = 3000) {
  return draw_training_set(brdf.ref(), {.pictures = count, .directions = count});
}

/// Returns a model of random logarithms in [-1, 0].
inline LogModel random_model(const std::string& expression, const std::vector<std::string>& tables,
                             std::size_t channels) {
  LogModel model{.spec = parse_model_spec(expression, tables, true), .channels = channels, .log_values = {}};
  Pcg32 random(3);
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t) {
    model.log_values.emplace_back(model.spec.tables[t].layout.node_count() * model.step(t));
    for (double& v : model.log_values.back()) v = -random.uniform();
  }
  return model;
}

/// Returns the model's values at the set's pairs.
inline std::vector<double> evaluate(const LogModel& model, const TrainingSet& set) {
  const FactoredBrdf brdf = to_brdf(model, TableFormat::single);
  std::vector<double> f(set.size() * model.channels);
  for (std::size_t i = 0; i < set.size(); ++i)
    brdf.eval(set.pairs[i].wi, set.pairs[i].wo, std::span(f).subspan(i * model.channels, model.channels));
  return f;
}

}  // namespace burnish::fixtures
