// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/byte_count.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

namespace {

// Highlights are narrow, but a gamma-corrected picture shows their flanks as wide rings. So nodes are only slightly
// denser at the normal. theta_m spans twice the angle, and only its beginning matters.
constexpr Warp kHalfWarp{WarpKind::power, 0.8}, kDeviationWarp{WarpKind::power, 0.5};
constexpr Warp kSkewWarp{WarpKind::power, 0.7};
// A direction between wi or wo and the half vector; both projections together are reciprocal.
constexpr Projection kProjectSkew{.wi = 1, .wo = 0.5}, kProjectSkewSwapped{.wi = 0.5, .wo = 1};

// An isotropic model has grids from this many texels on; its 1-D tables take at most kMaxLineTexels.
constexpr double kGridTexels = 1500, kThreeGridTexels = 6000, kMaxLineTexels = 2000;
// The factor that distinguishes mirror images: kTwistNodes from one side to the other (3 and 7 nodes were no better),
// and its share (.04 to .4 were about as good).
constexpr int kTwistNodes = 5;
constexpr double kTwistShare = 0.25;
// The tables for the order of the directions: one grid for all lobes and a line for each lobe. The grid's nodes along
// theta_i are more if other factors have grids too.
constexpr int kOrderNodes = 4, kManyOrderNodes = 8;
constexpr double kOrderShare = 0.3, kOrderLineShare = 0.1;
constexpr Warp kOrderWarp{WarpKind::power, 0.5};
constexpr int kMaxLineNodes = 1024;  // nodes of a line: finer than any measurement

// Lobes with more texels resolve rings; more lobes follow the change of the highlight with the angles.
int lobes_for(double texels) {
  return std::clamp(static_cast<int>(std::lround(std::log2(texels / 82))), 1, 8);
}

// Returns the cost of a node in texels; a table with one channel for all costs only a part of a texel.
double node_cost(const PlannedFactor& factor, std::size_t channels, std::size_t texel_bytes) {
  if (!factor.grey) return 1;
  return static_cast<double>(shared_texel_bytes(channels, texel_bytes)) / static_cast<double>(texel_bytes);
}

/// A plan's lobes, whose tables have no nodes yet.
struct Unsized {
  ModelSpec spec;
  std::vector<const PlannedFactor*> factors;  ///< the factor of each table
};

std::size_t add_table(const PlannedFactor& factor, const std::string& suffix, Unsized& model) {
  model.spec.tables.push_back({.name = factor.name + suffix,
                               .layout = {.shape = factor.shape,
                                          .width = 0,
                                          .height = 0,
                                          .warp = factor.warp,
                                          .warp_y = factor.second_warp},
                               .shared = factor.grey});
  model.factors.push_back(&factor);
  return model.factors.size() - 1;
}

// Appends lobes: first the tables that they share, then each lobe's own.
void add_lobes(const std::vector<PlannedFactor>& factors, std::size_t lobes, bool numbered, Unsized& model) {
  std::vector<std::size_t> common(factors.size());
  for (std::size_t k = 0; k < factors.size(); ++k)
    if (factors[k].every_lobe) common[k] = add_table(factors[k], "", model);
  for (std::size_t j = 0; j < lobes; ++j) {
    std::vector<FactorUse> lobe;
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const std::size_t table = factors[k].every_lobe
                                    ? common[k]
                                    : add_table(factors[k], numbered ? std::to_string(j + 1) : "", model);
      for (const Projection& use : factors[k].uses)
        lobe.push_back({.table = table, .projection = use, .projection_y = factors[k].second});
    }
    model.spec.lobes.push_back(std::move(lobe));
  }
}

// Sets the size of a factor's table to at most `nodes` nodes.
void set_size(const PlannedFactor& factor, double nodes, ModelSpec::TableSpec& table) {
  const bool line = factor.shape == TableShape::line;
  const int least = factor.shape == TableShape::disk ? 3 : 2;
  const auto side = [](double n) { return std::min(static_cast<int>(n), kMaxLineNodes); };
  const int width = factor.width > 0 ? factor.width : side(line ? nodes : std::sqrt(nodes)),
            height = line               ? 1
                     : factor.width > 0 ? side(nodes / factor.width)
                                        : width;
  if (width < least || (!line && height < least))
    throw Error(fmt::format("fit: expected a budget that holds every table, found {} texels for '{}'",
                            static_cast<int>(nodes), table.name));
  table.layout.width = width;
  table.layout.height = height;
}

// Distributes at most `texels` texels among the tables [first, end), which belong to `factors`.
void share_texels(const std::vector<PlannedFactor>& factors, std::size_t lobes, double texels,
                  std::size_t channels, std::size_t texel_bytes, std::size_t first, std::size_t end,
                  Unsized& model) {
  double shares = 0;
  for (const PlannedFactor& factor : factors)
    shares += factor.share * static_cast<double>(factor.every_lobe ? 1 : lobes);
  for (std::size_t t = first; t < end; ++t) {
    const PlannedFactor& factor = *model.factors[t];
    // Shares are of bytes.
    const double nodes = factor.share / shares * texels / node_cost(factor, channels, texel_bytes);
    set_size(factor, nodes, model.spec.tables[t]);
  }
}

}  // namespace

LobePlan default_plan(std::size_t bytes, int lobes, bool isotropic, std::size_t texel_bytes) {
  LobePlan plan{.lobes = lobes};
  const auto line = [](const char* name, std::vector<Projection> uses, double share, Warp warp = {}) {
    return PlannedFactor{
        .name = name, .shape = TableShape::line, .uses = std::move(uses), .share = share, .warp = warp};
  };
  if (isotropic) {
    const double texels = static_cast<double>(bytes) / static_cast<double>(texel_bytes);
    // Beyond some hundred texels a lobe, the limit is the product of three 1-D tables, not their resolution.
    const bool grids = texels > kGridTexels, three = texels > kThreeGridTexels;
    const double lines = grids ? std::min(0.5, kMaxLineTexels / texels) : 1;
    if (lobes <= 0) plan.lobes = lobes_for(lines * texels);
    plan.factors = {line("p", {kProjectWo, kProjectWi}, 0.083), line("q", {kProjectHalf}, 0.587, kHalfWarp),
                    line("m", {kProjectDeviation}, 0.183, kDeviationWarp),
                    line("r", {kProjectDifference}, 0.147)};
    if (plan.lobes > 1) {
      // The common part of all q, such as rings of films, is finely resolved in one table z; each lobe's own q is
      // coarse.
      plan.factors[1].share = 0.176;
      plan.factors.push_back(line("z", {kProjectHalf}, 1, kHalfWarp));
      plan.factors.back().every_lobe = true;
      plan.factors.push_back(line("s", {kProjectSkew, kProjectSkewSwapped}, 0.15, kSkewWarp));
    }
    const auto grid = [&](const char* name, Projection x, Projection y) {
      const auto warp = [](const Projection& p) { return p == kProjectDifference ? Warp{} : kDeviationWarp; };
      plan.factors.push_back(
          {name, TableShape::grid, {x}, (1 / lines - 1) / (three ? 3 : 1), warp(x), y, warp(y)});
    };
    if (grids) grid("g", kProjectHalf, kProjectDifference);
    if (three) {
      grid("k", kProjectDeviation, kProjectDifference);
      grid("x", kProjectHalf, kProjectDeviation);
    }
    return plan;
  }
  // The narrow factors of a highlight take few texels; nearly all others are q's.
  constexpr double kRing = 24;
  constexpr int kWide = 12;
  plan.lobes = lobes <= 0 ? 1 : lobes - 1;
  if (plan.lobes < 1) throw Error("fit: expected at least two lobes for an anisotropic source, found one");
  const double texels = static_cast<double>(bytes) / static_cast<double>(texel_bytes) / plan.lobes;
  const double ring = kRing / std::max(texels, 4 * kRing);
  plan.factors = {{"p", TableShape::disk, {kProjectWo, kProjectWi}, 0.04, {}, {}, {}},
                  {"q", TableShape::disk, {kProjectHalf}, 0.96 - 2 * ring, kHalfDiskWarp, {}, {}},
                  line("m", {kProjectDeviation}, ring, kDeviationWarp),
                  line("r", {kProjectDifference}, ring)};
  plan.wide = {line("a", {kProjectWo, kProjectWi}, 1), line("b", {kProjectHalf}, 1),
               line("c", {kProjectDifference}, 1)};
  plan.wide_texels = std::min(3 * kWide, static_cast<int>(texels / 4));
  return plan;
}

LobePlan plan_for(BrdfRef source, std::size_t bytes, int lobes, std::size_t texel_bytes) {
  LobePlan plan = default_plan(bytes, lobes, source.isotropic(), texel_bytes);
  if (!source.isotropic()) return plan;
  const auto add = [&](std::initializer_list<PlannedFactor> factors) {
    LobePlan more = plan;
    more.factors.insert(more.factors.end(), factors);
    if (plan_fits(more, bytes, source.channels(), texel_bytes)) plan = std::move(more);
  };
  const bool many = static_cast<double>(bytes) > kGridTexels * static_cast<double>(texel_bytes);
  if (order_matters(source))
    add({{.name = "c",
          .shape = TableShape::grid,
          .uses = {kProjectWi},
          .share = kOrderShare * plan.lobes,
          .second = kProjectHalf,
          .second_warp = kOrderWarp,
          .width = many ? kManyOrderNodes : kOrderNodes,
          .every_lobe = true},
         {.name = "a", .shape = TableShape::line, .uses = {kProjectWi}, .share = kOrderLineShare}});
  if (mirror_asymmetry(source) > kMinAsymmetry)
    add({{.name = "w",
          .shape = TableShape::grid,
          .uses = {kProjectTwist},
          .share = kTwistShare,
          .second = kProjectHalf,
          .second_warp = kHalfWarp,
          .width = kTwistNodes}});
  return plan;
}

bool plan_fits(const LobePlan& plan, std::size_t bytes, std::size_t channels, std::size_t texel_bytes) {
  try {
    plan_to_spec(plan, bytes, channels, texel_bytes);
    return true;
  } catch (const Error&) {
    return false;
  }
}

ModelSpec plan_to_spec(const LobePlan& plan, std::size_t bytes, std::size_t channels,
                       std::size_t texel_bytes) {
  const auto lobes = static_cast<std::size_t>(plan.lobes);
  if (lobes > 1 && std::ranges::all_of(plan.factors, &PlannedFactor::every_lobe))
    throw Error("fit: expected a factor with a table for each lobe, found none");
  Unsized model;
  if (!plan.wide.empty()) add_lobes(plan.wide, 1, false, model);
  const std::size_t wide_tables = model.factors.size();
  add_lobes(plan.factors, lobes, true, model);

  // Without nodes the model takes only the bytes of its numbers. The texels share the other bytes.
  const std::size_t numbers = model_bytes(model.spec, channels, texel_bytes);
  const std::size_t texels = bytes > numbers ? (bytes - numbers) / texel_bytes : 0;
  const auto wide = static_cast<std::size_t>(plan.wide_texels);
  share_texels(plan.wide, 1, static_cast<double>(wide), channels, texel_bytes, 0, wide_tables, model);
  share_texels(plan.factors, lobes, static_cast<double>(texels > wide ? texels - wide : 0), channels,
               texel_bytes, wide_tables, model.factors.size(), model);
  return std::move(model.spec);
}

}  // namespace burnish
