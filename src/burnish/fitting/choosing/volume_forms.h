#pragma once

#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// What an isotropic source asks of its tables.
struct SourceTraits {
  bool twisted;  ///< not its own mirror image
  bool ordered;  ///< the order of the directions matters
  bool retro;    ///< has a lobe about wi = wo
};

SourceTraits traits_of(BrdfRef source);

/// The usual one of volume_specs: a volume and, of more fetches, a line along theta_h and so on. Of one that is
/// `ordered` a grid c(theta_i,theta_h) comes second. Throws Error where the bytes hold no such tables.
ModelSpec usual_volume_spec(const CostLimit& limit, std::size_t channels, const SourceTraits& traits);

/// Isotropic models of one lobe within the limit: g(theta_h,theta_d,phi_d), with a line z(theta_h) from two
/// fetches on, p(wo) p(wi) from four, r(theta_d) of three and from five on, a grid k(theta_m,theta_d) from
/// six on, s(wi + wo/2) s(wi/2 + wo) from eight on. They differ in how the volume's nodes are shared out among its
/// axes. From 600 texels and three fetches on one has a grid b(theta_d,theta_h) in place of r, and of four fetches k in
/// place of p(wo) p(wi). Of a source that is not its own mirror image the volume is g(theta_h,theta_d,phi_s), and the
/// model with the grid comes first, from two fetches on, of two in place of z. Of one for which the order of the
/// directions matters (order_tables.h) the models that come first have a grid c(theta_i,theta_h) second; of one that
/// backscatters() nodes crowd at theta_d = 0. Throws Error where the bytes hold no such tables.
std::vector<ModelSpec> volume_specs(BrdfRef source, const CostLimit& limit);

}  // namespace burnish
