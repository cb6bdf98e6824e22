#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A factor of a lobe before its size is known: a table, looked up by one projection or, for a factor that
/// both directions share, by two that exchanging them exchanges.
struct PlannedFactor {
  std::string name;
  TableShape shape = TableShape::line;
  std::vector<Projection> uses;
  double share = 1;  ///< of its lobe's texels, relative to the other factors' shares; > 0
  Warp warp;
  Projection second;  ///< of a grid, which has one use
  Warp second_warp;
  int width = 0;            ///< nodes of a grid along its first axis; 0: as many as along the second
  bool every_lobe = false;  ///< one table for all lobes
  bool grey = false;        ///< one channel for all

  friend bool operator==(const PlannedFactor&, const PlannedFactor&) = default;
};

/// What the lobes of a model are made of. An anisotropic model has a lobe of 1-D tables for what is spread
/// wide beside the lobes whose factors are hemispheres.
struct LobePlan {
  int lobes = 1;  ///< without the wide one
  std::vector<PlannedFactor> factors;
  std::vector<PlannedFactor> wide;  ///< empty: none
  int wide_texels = 0;

  friend bool operator==(const LobePlan&, const LobePlan&) = default;
};

/// The plan that serves a number of bytes best, measured on the materials of docs/results/accuracy.md: lobes
/// p(wo) p(wi) q(theta_h) m(theta_m) r(theta_d), where there are several also s(wi + wo/2) s(wi/2 + wo) and
/// one z(theta_h) for all of them; grids over two of the three angles where there are texels to spare; p and
/// q hemispheres where the source is anisotropic. `lobes` counts the wide one too; 0: chosen by the bytes.
LobePlan default_plan(std::size_t bytes, int lobes, bool isotropic, std::size_t texel_bytes);

/// default_plan for a source; where an isotropic one is not its own mirror image, each lobe has also a factor
/// w(theta_t, theta_h), and where the order of the directions matters (order_tables.h), each has a(theta_i) and all
/// one c(theta_i, theta_h), unless the bytes hold no such tables.
LobePlan plan_for(BrdfRef source, std::size_t bytes, int lobes, std::size_t texel_bytes);

/// The largest model of the plan whose tables and numbers fit `bytes`, see FactoredBrdf::bytes. Throws Error
/// if a table would have fewer than two nodes (a hemisphere: 3 x 3), or no factor of several lobes is a
/// lobe's own. Tables for every lobe come first and keep the factor's name; the others' names end in the
/// lobe's number.
ModelSpec plan_to_spec(const LobePlan& plan, std::size_t bytes, std::size_t channels,
                       std::size_t texel_bytes);

/// Whether plan_to_spec has room for every table.
bool plan_fits(const LobePlan& plan, std::size_t bytes, std::size_t channels, std::size_t texel_bytes);

}  // namespace burnish
