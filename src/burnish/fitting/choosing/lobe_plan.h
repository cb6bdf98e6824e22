// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A factor of a lobe before its size is known: a table, looked up by one projection. A factor that both directions
/// share is looked up by two projections, which are swapped when the directions are exchanged.
struct PlannedFactor {
  std::string name;
  TableShape shape = TableShape::line;
  std::vector<Projection> uses;
  double share = 1;  ///< share of its lobe's texels, relative to the other factors; > 0
  Warp warp;
  Projection second;  ///< second axis of a grid, which has one use
  Warp second_warp;
  int width = 0;            ///< nodes of a grid along its first axis; 0: as along the second
  bool every_lobe = false;  ///< one table for all lobes
  bool grey = false;        ///< one channel for all

  friend bool operator==(const PlannedFactor&, const PlannedFactor&) = default;
};

/// The composition of a model's lobes. An anisotropic model has lobes whose factors are hemispheres, and one lobe of
/// 1-D tables for what is spread wide.
struct LobePlan {
  int lobes = 1;  ///< without the wide lobe
  std::vector<PlannedFactor> factors;
  std::vector<PlannedFactor> wide;  ///< empty: none
  int wide_texels = 0;

  friend bool operator==(const LobePlan&, const LobePlan&) = default;
};

/// Returns the plan that serves a number of bytes best, measured on the materials of docs/results/accuracy.md. Its
/// lobes are p(wo) p(wi) q(theta_h) m(theta_m) r(theta_d). Several lobes also have s(wi + wo/2) s(wi/2 + wo), and
/// share one z(theta_h). If there are texels to spare, they have grids over two of the three angles. For an
/// anisotropic source, p and q are hemispheres. `lobes` counts the wide lobe too; 0: the bytes decide.
LobePlan default_plan(std::size_t bytes, int lobes, bool isotropic, std::size_t texel_bytes);

/// Returns default_plan for a source, with more factors if the bytes hold their tables. If an isotropic source is not
/// its own mirror image, each lobe also has a factor w(theta_t, theta_h). If the order of the directions matters
/// (order_tables.h), each lobe has a(theta_i), and all lobes share one c(theta_i, theta_h).
LobePlan plan_for(BrdfRef source, std::size_t bytes, int lobes, std::size_t texel_bytes);

/// Returns the largest model of the plan whose tables and numbers fit `bytes`, see FactoredBrdf::bytes. Throws Error
/// if a table would have fewer than two nodes (a hemisphere: 3 x 3), or if several lobes have no factor of their own.
/// Tables for every lobe come first and keep the factor's name; the names of other tables end in the lobe's number.
ModelSpec plan_to_spec(const LobePlan& plan, std::size_t bytes, std::size_t channels,
                       std::size_t texel_bytes);

/// True if plan_to_spec has room for every table.
bool plan_fits(const LobePlan& plan, std::size_t bytes, std::size_t channels, std::size_t texel_bytes);

}  // namespace burnish
