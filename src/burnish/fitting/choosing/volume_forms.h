// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Properties of an isotropic source that its tables depend on.
struct SourceTraits {
  bool twisted;  ///< not its own mirror image
  bool ordered;  ///< the order of the directions matters
  bool retro;    ///< has a lobe about wi = wo
};

SourceTraits traits_of(BrdfRef source);

/// Returns the usual model of volume_specs: a volume and, with more fetches, a line along theta_h and so on. For an
/// `ordered` source a grid c(theta_i,theta_h) comes second. Throws Error if the bytes hold no such tables.
ModelSpec usual_volume_spec(const CostLimit& limit, std::size_t channels, const SourceTraits& traits);

/// Returns isotropic models of one lobe within the limit. They differ in the distribution of the volume's nodes among
/// its axes. Throws Error if the bytes hold no model.
///
/// The volume is g(theta_h,theta_d,phi_d). The other tables depend on the number of fetches:
/// - z(theta_h), a line: from two on;
/// - p(wo) p(wi): from four on;
/// - r(theta_d): three, and from five on;
/// - k(theta_m,theta_d), a grid: from six on;
/// - s(wi + wo/2) s(wi/2 + wo): from eight on.
///
/// From 600 texels and three fetches on, one model has a grid b(theta_d,theta_h) instead of r. With four fetches it
/// has k instead of p(wo) p(wi).
///
/// Sources with these properties change the models:
/// - not its own mirror image: the volume is g(theta_h,theta_d,phi_s). The model with the grid b comes first, from
///   two fetches on, for two instead of z;
/// - the order of the directions matters (order_tables.h): the first models have a grid c(theta_i,theta_h) second;
/// - backscatters(): nodes are denser at theta_d = 0.
std::vector<ModelSpec> volume_specs(BrdfRef source, const CostLimit& limit);

}  // namespace burnish
