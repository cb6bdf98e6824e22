// SPDX-License-Identifier: Apache-2.0
#include <burnish/eval/spatial_eval.h>

namespace burnish {

SpatialEvaluator::SpatialEvaluator(SpatialBrdf surface)
    : surface_(std::make_shared<const SpatialBrdf>(std::move(surface))),
      lobes_(surface_->lobes()),
      framed_(surface_->maps().normals || surface_->maps().tangents) {}

SpatialEvaluator::Place SpatialEvaluator::place(const SurfaceMap::Place& at) const noexcept {
  Place place;
  place.frame = surface_->frame(at);
  for (std::size_t j = 0; j < lobes_.lobes(); ++j) {
    const SpatialBrdf::Weight weight = surface_->weight(j, at);
    float* const to = place.weights.data() + LobeEvaluator::kWeightStride * j;
    for (std::size_t c = 0; c < weight.size(); ++c) to[c] = weight[c];
    to[3] = 0;
  }
  return place;
}

SpatialEvaluator::Place SpatialEvaluator::place(double u, double v, double lod) const noexcept {
  return place(surface_->map_place(u, v, lod));
}

SpatialEvaluator::Place SpatialEvaluator::texel(int x, int y) const noexcept {
  return place(surface_->maps().weights.front().place_of_texel(x, y));
}

void SpatialEvaluator::eval(const Place& place, Vec3 wi, Vec3 wo, std::span<float> f) const noexcept {
  const auto weights = std::span(place.weights).first(LobeEvaluator::kWeightStride * lobes_.lobes());
  if (framed_)
    lobes_.eval(place.frame.local(wi), place.frame.local(wo), weights, f);
  else
    lobes_.eval(wi, wo, weights, f);
}

}  // namespace burnish
