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

// Texels of the models that are tried. Up to about 500 a fit is direct and takes milliseconds; hemispheres
// need more, and are then solved by iterations.
constexpr std::array<std::size_t, 2> kLineSizes{140, 400}, kDiskSizes{160, 1200};
constexpr int kMaxLine = 1024;  // nodes, finer than any measurement
constexpr int kMaxDisk = 256;   // nodes along a side

// Nodes of a line p that is fine enough to tell the angles of a lattice apart, 1.4 degrees each, and the part of the
// texels that it may take: what it takes from a small q it does not give back.
constexpr int kFineP = 64;
constexpr double kMaxFineP = 0.25;

// Factor sets, the fullest first: the others serve budgets that hold few texels.
const std::array<std::string, 5> kFactorSets{"pqmr", "pqm", "pqr", "pq", "q"};

bool is_disk(const PlannedFactor& factor) {
  return factor.shape == TableShape::disk;
}

int least_side(const PlannedFactor& factor) {
  return is_disk(factor) ? 3 : 2;
}

// Nodes along a side of a factor's table of at most so many nodes.
int side_of(const PlannedFactor& factor, double nodes) {
  const int most = is_disk(factor) ? kMaxDisk : kMaxLine;
  return static_cast<int>(std::min<double>(most, is_disk(factor) ? std::sqrt(nodes) : nodes));
}

std::size_t nodes_of(const PlannedFactor& factor, int side) {
  const auto n = static_cast<std::size_t>(side);
  return is_disk(factor) ? n * n : n;
}

// The factors of one set, as budgets plan them.
std::vector<PlannedFactor> factors_of(const std::string& set, std::size_t texels, bool isotropic) {
  std::vector<PlannedFactor> chosen;
  // of so few bytes of one each that no grids are planned
  const std::size_t bytes = isotropic ? 1 : texels;
  for (PlannedFactor& factor : default_plan(bytes, isotropic ? 1 : 2, isotropic, 1).factors)
    if (set.find(factor.name) != set.npos) chosen.push_back(std::move(factor));
  return chosen;
}

// The lobe whose tables have at most `texels` texels together: each its share, but as many as it needs, p at least
// `least_p`, and q what is left. None where they do not suffice.
std::optional<ModelSpec> spec_of(const std::string& set, std::size_t texels, bool isotropic,
                                 int least_p = 0) {
  const std::vector<PlannedFactor> factors = factors_of(set, texels, isotropic);
  // sides by share, q's by what is left
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

  // one lobe of all
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

// Nodes of the factors of a material that backscatters, at most; the sides of k and of hemispheres are equal.
struct RetroSizes {
  int p = 48, q = 64, k = 24, b_h = 16, b_d = 40, a_d = 32, a_phi = 10;
};
constexpr int kRetroDiskP = 16, kRetroDiskQ = 32;  // p and q of anisotropic ones

// Its factors where fetches, one a letter, allow no more; p stands twice. Cross-validated relative errors of a tape:
// .170 of b by itself, .112 with k, .108 with q or .100 with p, .100 with both, .091 of all.
constexpr std::array<std::string_view, 6> kRetroFactors{"ppqkba", "ppqkb", "ppkb", "qkb", "kb", "b"};

// p(wo) p(wi) q(h) k(theta_m,theta_d) b(theta_h,theta_d) a(theta_d,phi_d), their nodes crowded at wi = wo, where b
// follows the angle of both, and a what is not round about it. p and q are hemispheres where it is anisotropic.
// Near wi = wo nodes of b and a are evenly spread in theta_d, as what is smooth over them has to be: over its root, a
// lobe of a flat top is so steep at the samples about it that the smoothest lobe is up to twice as high between them.
// Of these factors alone.
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
  const Warp highlight = factors.find('q') == factors.npos ? crowded : Warp{};  // b's alone without q
  std::vector<ModelSpec::TableSpec> tables = {polar("p", sizes.p), polar("q", sizes.q),
                                              grid("k", sizes.k, sizes.k, crowded, crowded),
                                              grid("b", sizes.b_h, sizes.b_d, highlight, even_at_zero),
                                              grid("a", sizes.a_d, sizes.a_phi, even_at_zero, Warp{})};
  // about wi = wo, where scans coarser than the lobe have no sample
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
