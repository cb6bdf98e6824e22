#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/fit_report.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Whether few bytes leave lobes of lines or hemispheres alone to serve: of an isotropic source where default_plan is
/// within the limit, of another always.
bool takes_lobes(BrdfRef source, const CostLimit& limit);
/// Whether the limit holds the tables of a model.
bool holds_model(BrdfRef source, const CostLimit& limit);
/// default_plan, of an anisotropic source with as many of its factors as the fetches allow.
LobePlan plan_within(BrdfRef source, const CostLimit& limit);

/// Isotropic models of one lobe within the limit: g(theta_h,theta_d,phi_d), with a line z(theta_h) from two
/// fetches on, p(wo) p(wi) from four, r(theta_d) of three and from five on, a grid k(theta_m,theta_d) from
/// six on, s(wi + wo/2) s(wi/2 + wo) from eight on. They differ in how the volume's nodes are shared out among its
/// axes. From 600 texels and three fetches on one has a grid b(theta_d,theta_h) in place of r, and of four fetches k in
/// place of p(wo) p(wi). Of a source that is not its own mirror image the volume is g(theta_h,theta_d,phi_s), and the
/// model with the grid comes first, from two fetches on, of two in place of z. Of one for which the order of the
/// directions matters (order_tables.h) the models that come first have a grid c(theta_i,theta_h) second; of one that
/// backscatters() nodes crowd at theta_d = 0. Throws Error where the bytes hold no such tables.
std::vector<ModelSpec> volume_specs(BrdfRef source, const CostLimit& limit);

/// The error of the models that try_fetches or try_hemispheres looks at may be this many times the least.
inline constexpr double kKneeFactor = 1.02;

/// Models of 2, 3, 4, 6, 8, 12 and 24 fetches that the bytes hold, and lobes of lines where takes_lobes has them for as
/// many as they take, volumes with a line beside them: each fitted to part of the set, the mean of its channels, in few
/// steps and judged on another. By rising fetches; the limit's own do not count. Deterministic.
std::vector<FetchTrial> try_fetches(BrdfRef source, const TrainingSet& set, CostLimit limit,
                                    const RefineOptions& options);
/// That of the fewest fetches whose error is within kKneeFactor of the least. Precondition: at least one trial.
const FetchTrial& trial_at_knee(std::span<const FetchTrial> trials);

/// How many pairs to draw for volumes, and where.
TrainingOptions training_for_volumes(const CostLimit& limit);

/// The set with more pixels of spheres lit from the viewer: theta_d is 0 there, at the edge of a volume, whose
/// nodes the pixels of other lights reach from one side only. As many as `share` of the pixels that there are,
/// half of them where theta_h is small, weighted as if they were spread evenly over the disk.
TrainingSet with_frontal_pixels(BrdfRef source, TrainingSet set, double share);

/// Fits the spec that serves best, of many nodes the first: each is fitted to part of the pairs in few steps
/// and judged on another part. The log-linear fit of its volume at fewer nodes is refined on part of the set,
/// then at all nodes on the whole. Throws Error as fit_homomorphic does.
LobesFit fit_volumes(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                     const RefineOptions& options);

}  // namespace burnish
