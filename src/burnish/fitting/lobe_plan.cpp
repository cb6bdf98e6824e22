#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/lobe_plan.h>

namespace burnish {

namespace {

// Highlights are narrow, but a gamma-corrected picture shows their skirts as wide rings: a mild crowding at
// the normal. theta_m spans twice the angle, and only its beginning matters.
constexpr Warp kHalfWarp{WarpKind::power, 0.8}, kDeviationWarp{WarpKind::power, 0.5};
constexpr Warp kDiskWarp{WarpKind::rational, 0.25};

constexpr std::size_t kNumberBytes = 4;  // of a scale, a warp's parameter or a projection's coefficient
// Of an isotropic model: from how many texels on it has grids, and how many its 1-D tables take at most.
constexpr double kGridTexels = 1500, kThreeGridTexels = 6000, kMostLineTexels = 2000;
constexpr int kMostSide = 1024;  // nodes of a line: finer than any measurement

// More texels for each of few lobes resolve rings, more lobes follow how the highlight changes with the
// angles.
int lobes_for(double texels) {
  return std::clamp(static_cast<int>(std::lround(std::log2(texels / 82))), 1, 8);
}

std::size_t coefficients(const Projection& p) {
  if (p.kind != Projection::Kind::affine || p == kProjectWi || p == kProjectWo || p == kProjectHalf) return 0;
  return static_cast<std::size_t>((p.wi != 0) + (p.wo != 0) + (p.mirror != 0) + (p.n != 0));
}

std::size_t number_bytes(const std::vector<PlannedFactor>& factors, int channels) {
  std::size_t numbers = static_cast<std::size_t>(channels);
  for (const PlannedFactor& factor : factors) {
    numbers += (factor.warp.kind != WarpKind::identity) + (factor.second_warp.kind != WarpKind::identity);
    for (const Projection& use : factor.uses) numbers += coefficients(use);
    if (factor.shape == TableShape::grid) numbers += coefficients(factor.second);
  }
  return numbers * kNumberBytes;
}

// Appends a lobe of at most `texels` texels.
void add_lobe(const std::vector<PlannedFactor>& factors, std::size_t texels, const std::string& suffix,
              ModelSpec& spec) {
  double shares = 0;
  for (const PlannedFactor& factor : factors) shares += factor.share;
  std::vector<FactorUse> lobe;
  for (const PlannedFactor& factor : factors) {
    const double nodes = factor.share / shares * static_cast<double>(texels);
    const bool line = factor.shape == TableShape::line, disk = factor.shape == TableShape::disk;
    const int width = std::min(static_cast<int>(line ? nodes : std::sqrt(nodes)), kMostSide);
    if (width < (disk ? 3 : 2))
      throw Error(fmt::format("fit: expected a budget that holds every table, found {} texels for '{}{}'",
                              static_cast<int>(nodes), factor.name, suffix));
    spec.tables.push_back({.name = factor.name + suffix,
                           .layout = {.shape = factor.shape,
                                      .width = width,
                                      .height = line ? 1 : width,
                                      .warp = factor.warp,
                                      .warp_y = factor.second_warp}});
    for (const Projection& use : factor.uses)
      lobe.push_back({.table = static_cast<int>(spec.tables.size()) - 1,
                      .projection = use,
                      .projection_y = factor.second});
  }
  spec.lobes.push_back(std::move(lobe));
}

}  // namespace

LobePlan default_plan(std::size_t bytes, int lobes, bool isotropic, std::size_t texel_bytes) {
  LobePlan plan{.lobes = lobes};
  const auto line = [](const char* name, std::vector<Projection> uses, double share, Warp warp = {}) {
    return PlannedFactor{name, TableShape::line, std::move(uses), share, warp, {}, {}};
  };
  if (isotropic) {
    const double texels = static_cast<double>(bytes) / static_cast<double>(texel_bytes);
    // Beyond some hundred texels a lobe, what three 1-D tables multiply to is missing more than resolution.
    const bool grids = texels > kGridTexels, three = texels > kThreeGridTexels;
    const double lines = grids ? std::min(0.5, kMostLineTexels / texels) : 1;
    if (lobes <= 0) plan.lobes = lobes_for(lines * texels);
    plan.factors = {line("p", {kProjectWo, kProjectWi}, 0.083), line("q", {kProjectHalf}, 0.587, kHalfWarp),
                    line("m", {kProjectDeviation}, 0.183, kDeviationWarp),
                    line("r", {kProjectDifference}, 0.147)};
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
  // The narrow factors of a highlight take few texels; what is left is nearly all q's.
  constexpr double kRing = 24;
  constexpr int kWide = 12;
  plan.lobes = lobes <= 0 ? 1 : lobes - 1;
  if (plan.lobes < 1) throw Error("fit: expected at least two lobes for an anisotropic source, found one");
  const double texels = static_cast<double>(bytes) / static_cast<double>(texel_bytes) / plan.lobes;
  const double ring = kRing / std::max(texels, 4 * kRing);
  plan.factors = {{"p", TableShape::disk, {kProjectWo, kProjectWi}, 0.04, {}, {}, {}},
                  {"q", TableShape::disk, {kProjectHalf}, 0.96 - 2 * ring, kDiskWarp, {}, {}},
                  line("m", {kProjectDeviation}, ring, kDeviationWarp),
                  line("r", {kProjectDifference}, ring)};
  plan.wide = {line("a", {kProjectWo, kProjectWi}, 1), line("b", {kProjectHalf}, 1),
               line("c", {kProjectDifference}, 1)};
  plan.wide_texels = std::min(3 * kWide, static_cast<int>(texels / 4));
  return plan;
}

ModelSpec plan_to_spec(const LobePlan& plan, std::size_t bytes, int channels, std::size_t texel_bytes) {
  const auto lobes = static_cast<std::size_t>(plan.lobes);
  const std::size_t numbers = lobes * number_bytes(plan.factors, channels) +
                              (plan.wide.empty() ? 0 : number_bytes(plan.wide, channels));
  const std::size_t texels = bytes > numbers ? (bytes - numbers) / texel_bytes : 0;
  const auto wide = static_cast<std::size_t>(plan.wide_texels);
  ModelSpec spec;
  if (!plan.wide.empty()) add_lobe(plan.wide, wide, "", spec);
  const std::size_t left = texels > wide ? texels - wide : 0;
  for (std::size_t j = 0; j < lobes; ++j)  // what division leaves goes to the first
    add_lobe(plan.factors, left / lobes + (j < left % lobes), std::to_string(j + 1), spec);
  return spec;
}

}  // namespace burnish
