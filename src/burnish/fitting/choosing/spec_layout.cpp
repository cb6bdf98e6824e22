#include <algorithm>
#include <cmath>

#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/spec_layout.h>

namespace burnish {

namespace {

constexpr int kMinDepth = 3, kMinDiskSide = 5;

}  // namespace

TableLayout volume_of(const VolumeForm& form, double nodes) {
  const double scale = std::cbrt(nodes / (form.half * form.difference * form.azimuth));
  const auto side = [](double n, int least) {
    return std::clamp(static_cast<int>(std::lround(n)), least, kMaxVolumeSide);
  };
  TableLayout layout{.shape = TableShape::volume, .warp = kHalfRootWarp};
  layout.depth = side(form.azimuth * scale, kMinDepth);
  const int widest = std::max(2, static_cast<int>(nodes) / (2 * layout.depth));  // leaves a width of two
  layout.height = std::min(side(std::sqrt(nodes / layout.depth * form.difference / form.half), 2), widest);
  layout.width = std::min(static_cast<int>(nodes) / (layout.depth * layout.height), kMaxVolumeSide);
  return layout;
}

ModelSpec at_fewer_nodes(ModelSpec spec, double share) {
  for (ModelSpec::TableSpec& table : spec.tables) {
    TableLayout& layout = table.layout;
    const auto shorten = [](int& side, double by, int least) {
      side = std::min(side, std::max(least, static_cast<int>(std::lround(side * by))));
    };
    if (layout.shape == TableShape::volume)
      for (int* side : {&layout.width, &layout.height, &layout.depth})
        shorten(*side, std::cbrt(share), kMinDepth);
    if (layout.shape == TableShape::disk)
      for (int* side : {&layout.width, &layout.height}) shorten(*side, std::sqrt(share), kMinDiskSide);
  }
  return spec;
}

std::size_t bytes_of(const ModelSpec& spec, std::size_t texel_bytes, std::size_t channels) {
  std::size_t numbers = spec.lobes.size() * channels, texels = 0;
  for (const ModelSpec::TableSpec& table : spec.tables) {
    texels += table.layout.node_count();
    for (const Warp& warp : {table.layout.warp, table.layout.warp_y, table.layout.warp_z})
      numbers += warp.kind != WarpKind::identity;
  }
  for (const std::vector<FactorUse>& lobe : spec.lobes)
    for (const FactorUse& use : lobe)
      for (const Projection& p : {use.projection, use.projection_y, use.projection_z})
        numbers += coefficient_count(p);
  return texels * texel_bytes + numbers * kNumberBytes;
}

}  // namespace burnish
