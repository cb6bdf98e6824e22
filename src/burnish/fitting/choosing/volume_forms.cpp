// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/fitting/choosing/volume_forms.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

namespace {

// Shares of the texels: lines along theta_h, which rings of films need; lines along other angles, which are smooth;
// and grids.
constexpr double kRingShare = 0.07, kLineShare = 0.016, kGridShare = 0.14;
constexpr int kMinLineNodes = 6, kMaxRingNodes = 512, kMaxVolumeLineNodes = 64;
// A grid b(theta_d,theta_h): its share of the texels, its nodes along theta_d for each along theta_h, its most
// texels, and its least nodes along theta_d. Models of kMinGridTexels or more try it.
constexpr double kHighlightShare = 0.2, kHighlightAspect = 1 / 1.5, kMaxHighlightTexels = 800;
constexpr int kMinHighlightNodes = 6;
constexpr std::size_t kMinGridTexels = 600;
constexpr Warp kVolumeDeviationWarp{WarpKind::power, 0.5}, kVolumeSkewWarp{WarpKind::power, 0.7};
// The grid for the order of the directions: its nodes along theta_i, and its share.
constexpr int kVolumeOrderNodes = 8;
constexpr double kVolumeOrderShare = 0.25;

// The distributions of a volume's nodes that are tried; the best one differs among materials.
constexpr VolumeForm kVolumeForms[] = {{30, 20, 6}, {40, 15, 6}, {24, 24, 6}, {20, 30, 6}};
constexpr double kBothSides = 2;  // times as many along the azimuth if it distinguishes mirror images
// The spacing of theta_d if a lobe stands at 0.
constexpr Warp kRetroWarp{WarpKind::power, 0.5};

// The first table beside the volume: a line along theta_h, for rings, or a grid over theta_h and theta_d.
enum class Beside { line, grid };

Warp difference_warp(const SourceTraits& traits) noexcept {
  return traits.retro ? kRetroWarp : Warp{};
}

/// Adds a model's tables and their uses; all belong to one lobe.
class SpecBuilder {
 public:
  void add(const char* name, TableLayout layout, const std::vector<FactorUse>& uses) {
    const std::size_t table = spec_.tables.size();
    spec_.tables.push_back({.name = name, .layout = layout});
    if (spec_.lobes.empty()) spec_.lobes.emplace_back();
    for (FactorUse use : uses) {
      use.table = table;
      spec_.lobes.front().push_back(use);
    }
  }
  void add_line(const char* name, int nodes, const std::vector<Projection>& over, Warp warp = {}) {
    std::vector<FactorUse> uses;
    for (const Projection& projection : over) uses.push_back({.projection = projection});
    add(name, {.width = nodes, .warp = warp}, uses);
  }
  const ModelSpec& spec() const noexcept { return spec_; }

 private:
  ModelSpec spec_;
};

/// The tables beside a volume, in the order in which they use up fetches.
class TablesBeside {
 public:
  TablesBeside(const CostLimit& limit, const SourceTraits& traits)
      : texels_(static_cast<double>(limit.bytes / limit.texel_bytes)),
        traits_(traits),
        left_(limit.fetches - 1) {}

  SpecBuilder build(Beside beside) && {
    const int line = nodes(kLineShare, kMaxVolumeLineNodes);
    if (traits_.ordered && takes(1)) add_by_half("c", kVolumeOrderNodes, kVolumeOrderShare, kProjectWi);
    const bool grid = beside == Beside::grid && takes(1);
    if (grid) add_highlight();
    if (takes(1)) builder_.add_line("z", nodes(kRingShare, kMaxRingNodes), {kProjectHalf}, kHalfRootWarp);
    if (takes(2)) builder_.add_line("p", line, {kProjectWo, kProjectWi});
    if (!grid && takes(1)) builder_.add_line("r", line, {kProjectDifference}, difference_warp(traits_));
    if (takes(1)) add_deviation();
    if (takes(2))
      builder_.add_line("s", line, {Projection{.wi = 1, .wo = 0.5}, Projection{.wi = 0.5, .wo = 1}},
                        kVolumeSkewWarp);
    return std::move(builder_);
  }

 private:
  int nodes(double share, int most) const {
    return std::clamp(static_cast<int>(share * texels_), kMinLineNodes, most);
  }
  bool takes(int fetches) {
    const bool room = left_ >= fetches;
    if (room) left_ -= fetches;
    return room;
  }
  void add_by_half(const char* name, int width, double share, const Projection& along_x, Warp warp = {}) {
    builder_.add(name,
                 {.shape = TableShape::grid,
                  .width = width,
                  .height = nodes(share / width, kMaxRingNodes),
                  .warp = warp,
                  .warp_y = kHalfRootWarp},
                 {{.projection = along_x, .projection_y = kProjectHalf}});
  }
  void add_highlight() {
    const double share = std::min(kHighlightShare, kMaxHighlightTexels / texels_);
    const int width =
        std::max(kMinHighlightNodes, static_cast<int>(std::sqrt(share * kHighlightAspect * texels_)));
    add_by_half("b", width, share, kProjectDifference, difference_warp(traits_));
  }
  void add_deviation() {
    const int side = std::max(4, static_cast<int>(std::sqrt(kGridShare * texels_)));
    builder_.add("k",
                 {.shape = TableShape::grid, .width = side, .height = side, .warp = kVolumeDeviationWarp},
                 {{.projection = kProjectDeviation, .projection_y = kProjectDifference}});
  }

  double texels_;
  const SourceTraits& traits_;
  int left_;  ///< fetches
  SpecBuilder builder_;
};

/// Returns the model whose tables a number of fetches allows; the volume takes the texels that the other tables
/// leave.
ModelSpec volume_spec(VolumeForm form, Beside beside, const CostLimit& limit, std::size_t channels,
                      const SourceTraits& traits) {
  SpecBuilder builder = TablesBeside(limit, traits).build(beside);

  // The volume has no nodes yet, so this count is that of the other tables and all numbers.
  builder.add("g", {.shape = TableShape::volume, .warp = kHalfRootWarp, .warp_y = difference_warp(traits)},
              {{.projection = kProjectHalf,
                .projection_y = kProjectDifference,
                .projection_z = traits.twisted ? kProjectSide : kProjectAzimuth}});
  ModelSpec spec = builder.spec();
  const std::size_t taken = model_bytes(spec, channels, limit.texel_bytes);
  const std::size_t rest = limit.bytes > taken ? (limit.bytes - taken) / limit.texel_bytes : 0;

  // The volume takes the rest.
  if (traits.twisted) form.azimuth *= kBothSides;
  TableLayout& volume = spec.tables.back().layout;
  volume = volume_of(form, static_cast<double>(rest));
  volume.warp_y = difference_warp(traits);
  if (volume.width < 2) throw Error("fit: expected a budget that holds a table of three axes");
  spec.tables.back().circle_z = traits.twisted;
  return spec;
}

}  // namespace

SourceTraits traits_of(BrdfRef source) {
  return {mirror_asymmetry(source) > kMinAsymmetry, order_matters(source), backscatters(source)};
}

ModelSpec usual_volume_spec(const CostLimit& limit, std::size_t channels, const SourceTraits& traits) {
  return volume_spec(kVolumeForms[0], Beside::line, limit, channels, traits);
}

std::vector<ModelSpec> volume_specs(BrdfRef source, const CostLimit& limit) {
  SourceTraits traits = traits_of(source);
  std::vector<ModelSpec> specs;
  const auto add = [&] {
    const auto add_form = [&](const VolumeForm& form, Beside beside) {
      specs.push_back(volume_spec(form, beside, limit, source.channels(), traits));
    };
    // Specs with many nodes are not tried: the first is taken.
    const int spare =
        limit.bytes / limit.texel_bytes < kMinGridTexels ? 0 : limit.fetches - 1 - traits.ordered;
    if (traits.twisted && spare >= 1) add_form(kVolumeForms[0], Beside::grid);
    for (const VolumeForm& form : kVolumeForms) add_form(form, Beside::line);
    if (!traits.twisted && spare >= 2) add_form(kVolumeForms[0], Beside::grid);
  };
  // The table of the order may not be worth its bytes, so there are models without it too.
  if (limit.fetches > 1 && traits.ordered) add();
  traits.ordered = false;
  add();
  return specs;
}

}  // namespace burnish
