// SPDX-License-Identifier: Apache-2.0
#include "opened_brdf.h"

#include <fmt/format.h>

#include <burnish/math/parallel.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish::python {

const TabulatedSampler& OpenedBrdf::sampler() const {
  std::call_once(sampler_made_, [&] {
    const FunctionWatch watch({this});
    sampler_.emplace(ref());
    watch.rethrow();  // the next call tries again
  });
  return *sampler_;
}

const KrigedNodes& OpenedBrdf::uncertain() const {
  const auto* scattered = std::get_if<ScatteredBrdf>(&source_.brdf);
  if (const KrigedNodes* function = scattered ? scattered->kriged() : nullptr) return *function;
  std::call_once(uncertain_made_, [&] {
    run_isolated([&] {
      const MeasuredNodes nodes = measured_nodes(source_);
      try {
        uncertain_ = std::make_unique<const KrigedNodes>(nodes, choose_covariance(nodes));
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", source_.name, error.what()));
      }
    });
  });
  return *uncertain_;
}

}  // namespace burnish::python
