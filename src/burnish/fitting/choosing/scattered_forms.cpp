// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <burnish/factors/byte_count.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/scattered_forms.h>

namespace burnish {

namespace {

// The texels of the models that are tried. Up to about 500 texels a fit is direct and takes milliseconds. Hemispheres
// need more and are solved by iterations.
constexpr std::array<std::size_t, 2> kLineSizes{140, 400}, kDiskSizes{160, 1200};
constexpr int kMaxLine = 1024;  // nodes, finer than any measurement
constexpr int kMaxDisk = 256;   // nodes along a side

// The nodes of a line p that distinguishes the angles of a lattice, 1.4 degrees apart, and the largest part of the
// texels for it. A larger part would harm a small q more than it helps.
constexpr int kFineP = 64;
constexpr double kMaxFineP = 0.25;

// Factor sets, the fullest first; the smaller ones are for budgets of few texels.
const std::array<std::string, 5> kFactorSets{"pqmr", "pqm", "pqr", "pq", "q"};

bool is_disk(const PlannedFactor& factor) {
  return factor.shape == TableShape::disk;
}

int least_side(const PlannedFactor& factor) {
  return is_disk(factor) ? 3 : 2;
}

// The nodes along a side of a factor's table that has at most so many nodes.
int side_of(const PlannedFactor& factor, double nodes) {
  const int most = is_disk(factor) ? kMaxDisk : kMaxLine;
  return static_cast<int>(std::min<double>(most, is_disk(factor) ? std::sqrt(nodes) : nodes));
}

std::size_t nodes_of(const PlannedFactor& factor, int side) {
  const auto n = static_cast<std::size_t>(side);
  return is_disk(factor) ? n * n : n;
}

// Returns the factors of one set, with the sizes of the default plan.
std::vector<PlannedFactor> factors_of(const std::string& set, std::size_t texels, bool isotropic) {
  std::vector<PlannedFactor> chosen;
  // The isotropic plan gets so few bytes that it has no grids.
  const std::size_t bytes = isotropic ? 1 : texels;
  for (PlannedFactor& factor : default_plan(bytes, isotropic ? 1 : 2, isotropic, 1).factors)
    if (set.find(factor.name) != set.npos) chosen.push_back(std::move(factor));
  return chosen;
}

// Returns a lobe whose tables have at most `texels` texels together. Each table has its share, but at least the nodes
// that it needs; p has at least `least_p`, and q takes the rest. None if the texels are too few.
std::optional<ModelSpec> spec_of(const std::string& set, std::size_t texels, bool isotropic,
                                 int least_p = 0) {
  const std::vector<PlannedFactor> factors = factors_of(set, texels, isotropic);
  // Sides follow from shares; q's side follows from the rest.
  double shares = 0;
  for (const PlannedFactor& factor : factors) shares += factor.share;
  std::vector<int> sides;
  std::size_t left = texels;
  const auto q = std::ranges::find(factors, "q", &PlannedFactor::name);
  for (const PlannedFactor& factor : factors) {
    const double nodes = factor.share / shares * static_cast<double>(texels);
    const int least = factor.name == "p" ? std::max(least_p, least_side(factor)) : least_side(factor);
    sides.push_back(std::max(least, side_of(factor, nodes)));
    if (factor.name == q->name) continue;
    const std::size_t taken = nodes_of(factor, sides.back());
    if (taken > left) return std::nullopt;
    left -= taken;
  }
  const int side = side_of(*q, static_cast<double>(left));
  if (side < least_side(*q)) return std::nullopt;
  sides[static_cast<std::size_t>(q - factors.begin())] = side;

  // All factors form one lobe.
  ModelSpec spec;
  spec.lobes.emplace_back();
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const PlannedFactor& factor = factors[k];
    spec.tables.push_back({.name = factor.name,
                           .layout = {.shape = factor.shape,
                                      .width = sides[k],
                                      .height = is_disk(factor) ? sides[k] : 1,
                                      .warp = factor.warp}});
    for (const Projection& use : factor.uses)
      spec.lobes.front().push_back({.table = k, .projection = use, .projection_y = {}});
  }
  return spec;
}

// The most nodes of the factors of a material that backscatters; k and hemispheres have equal sides.
struct RetroSizes {
  int p = 48, q = 64, k = 24, b_h = 16, b_d = 40, a_d = 32, a_phi = 10;
};
constexpr int kRetroDiskP = 16, kRetroDiskQ = 32;  // sides of p and q of anisotropic materials

// The lobe's factors for a limit of fetches, one a letter; p stands twice. Cross-validated relative errors of a tape
// were .170 with b alone, .112 with k, .108 with q or .100 with p, .100 with both, and .091 with all.
constexpr std::array<std::string_view, 6> kRetroFactors{"ppqkba", "ppqkb", "ppkb", "qkb", "kb", "b"};

// Returns a lobe of the given factors among p(wo) p(wi) q(h) k(theta_m,theta_d) b(theta_h,theta_d) a(theta_d,phi_d),
// with denser nodes at wi = wo. There b follows the angle of both directions, and a the deviation from a round lobe.
// For an anisotropic material, p and q are hemispheres.
//
// Near wi = wo, nodes of b and a are evenly spaced in theta_d, so that tables that are smooth over their nodes are
// smooth over theta_d. Nodes spaced by its root make a flat-topped lobe so steep at the neighbouring samples that the
// smoothest lobe is up to twice as high between them.
ModelSpec retro_spec(const RetroSizes& sizes, bool isotropic, std::string_view factors) {
  const Warp crowded{WarpKind::power, 0.5}, even_at_zero{WarpKind::rational, 0.08};
  const auto polar = [&](const char* name, int nodes) {
    const TableLayout line{.shape = TableShape::line, .width = nodes, .height = 1},
        disk{.shape = TableShape::disk, .width = nodes, .height = nodes};
    return ModelSpec::TableSpec{.name = name, .layout = isotropic ? line : disk};
  };
  const auto grid = [](const char* name, int width, int height, Warp warp, Warp warp_y) {
    return ModelSpec::TableSpec{
        .name = name,
        .layout = {
            .shape = TableShape::grid, .width = width, .height = height, .warp = warp, .warp_y = warp_y}};
  };
  // Without q, b alone follows the highlight.
  const Warp highlight = factors.find('q') == factors.npos ? crowded : Warp{};
  std::vector<ModelSpec::TableSpec> tables = {polar("p", sizes.p), polar("q", sizes.q),
                                              grid("k", sizes.k, sizes.k, crowded, crowded),
                                              grid("b", sizes.b_h, sizes.b_d, highlight, even_at_zero),
                                              grid("a", sizes.a_d, sizes.a_phi, even_at_zero, Warp{})};
  // These tables are even about wi = wo, where scans coarser than the lobe have no sample.
  tables[2].even_y = tables[3].even_y = tables[4].pole_x = true;
  const std::vector<FactorUse> uses = {
      {.table = 0, .projection = kProjectWo, .projection_y = {}},
      {.table = 0, .projection = kProjectWi, .projection_y = {}},
      {.table = 1, .projection = kProjectHalf, .projection_y = {}},
      {.table = 2, .projection = kProjectDeviation, .projection_y = kProjectDifference},
      {.table = 3, .projection = kProjectHalf, .projection_y = kProjectDifference},
      {.table = 4, .projection = kProjectDifference, .projection_y = kProjectAzimuth}};
  ModelSpec spec;
  std::vector<FactorUse>& lobe = spec.lobes.emplace_back();
  for (std::size_t t = 0; t < tables.size(); ++t) {
    if (factors.find(tables[t].name) == factors.npos) continue;
    for (FactorUse use : uses)
      if (use.table == t) {
        use.table = spec.tables.size();
        lobe.push_back(use);
      }
    spec.tables.push_back(std::move(tables[t]));
  }
  return spec;
}

}  // namespace

std::vector<std::string> scattered_factor_sets(int fetches, bool isotropic) {
  std::vector<std::string> sets(kFactorSets.begin(), kFactorSets.end());
  if (fetches > 0)
    std::erase_if(sets, [&](const std::string& set) {
      std::size_t uses = 0;
      for (const PlannedFactor& factor : factors_of(set, kDiskSizes.front(), isotropic))
        uses += factor.uses.size();
      return uses > static_cast<std::size_t>(fetches);
    });
  return sets;
}

std::optional<ModelSpec> scattered_spec(const std::string& set, std::size_t bytes, std::size_t most,
                                        const SampleSource& source, TableFormat format, int least_p) {
  const std::size_t texel = texel_bytes(format, source.channels);
  for (std::size_t texels = std::min(most, bytes / texel); texels > 0; --texels) {
    std::optional<ModelSpec> spec = spec_of(set, texels, source.isotropic, least_p);
    if (!spec || model_bytes(*spec, source.channels, format) <= bytes) return spec;
  }
  return std::nullopt;
}

std::vector<ModelSpec> scattered_specs(const SampleSource& source, std::size_t bytes, TableFormat format,
                                       const std::vector<std::string>& sets) {
  std::vector<ModelSpec> specs;
  const auto add = [&](const std::string& set, std::size_t most, int least_p = 0) {
    std::optional<ModelSpec> spec = scattered_spec(set, bytes, most, source, format, least_p);
    if (!spec) return;
    const auto same = [&](const ModelSpec& other) {
      return other.tables.size() == spec->tables.size() &&
             std::ranges::equal(other.tables, spec->tables, {}, &ModelSpec::TableSpec::layout,
                                &ModelSpec::TableSpec::layout);
    };
    if (std::ranges::none_of(specs, same)) specs.push_back(std::move(*spec));
  };
  for (const std::size_t size : source.isotropic ? kLineSizes : kDiskSizes) add(sets.front(), size);
  const std::size_t texels = bytes / texel_bytes(format, source.channels);
  if (source.isotropic && kFineP <= kMaxFineP * static_cast<double>(texels))
    add(sets.front(), kLineSizes.back(), kFineP);
  if (specs.size() <= 1 || sets.size() < kFactorSets.size())
    for (const std::string& set : sets) add(set, kLineSizes.front());
  return specs;
}

std::optional<ModelSpec> retro_spec_within(std::size_t bytes, const SampleSource& source, TableFormat format,
                                           int fetches) {
  for (const std::string_view factors : kRetroFactors) {
    if (fetches > 0 && factors.size() > static_cast<std::size_t>(fetches)) continue;
    for (const double share : {1.0, 0.7, 0.5, 0.35}) {
      const auto part = [share](int nodes) { return std::max(4, static_cast<int>(share * nodes)); };
      RetroSizes whole;
      if (!source.isotropic) {
        whole.p = kRetroDiskP;
        whole.q = kRetroDiskQ;
      }
      const ModelSpec spec = retro_spec({part(whole.p), part(whole.q), part(whole.k), part(whole.b_h),
                                         part(whole.b_d), part(whole.a_d), part(whole.a_phi)},
                                        source.isotropic, factors);
      if (model_bytes(spec, source.channels, format) <= bytes) return spec;
    }
  }
  return std::nullopt;
}

std::size_t least_scattered_bytes(std::size_t channels, bool isotropic, TableFormat format) {
  const std::string& least = kFactorSets.back();
  std::size_t texels = 1;
  while (!spec_of(least, texels, isotropic)) ++texels;
  return model_bytes(*spec_of(least, texels, isotropic), channels, format);
}

}  // namespace burnish
