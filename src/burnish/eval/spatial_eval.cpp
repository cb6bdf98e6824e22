#include <burnish/eval/spatial_eval.h>

namespace burnish {

SpatialEvaluator::SpatialEvaluator(SpatialBrdf surface)
    : surface_(std::make_shared<const SpatialBrdf>(std::move(surface))), lobes_(surface_->lobes()) {}

SpatialEvaluator::Place SpatialEvaluator::place(double u, double v, double lod) const noexcept {
  Place place;
  place.frame = surface_->frame(u, v, lod);
  for (std::size_t j = 0; j < lobes_.lobes(); ++j) {
    const SpatialBrdf::Weight weight = surface_->weight(j, u, v, lod);
    float* const to = place.weights.data() + LobeEvaluator::kWeightStride * j;
    for (std::size_t c = 0; c < weight.size(); ++c) to[c] = weight[c];
    to[3] = 0;
  }
  return place;
}

SpatialEvaluator::Place SpatialEvaluator::texel(int x, int y) const noexcept {
  return place((x + 0.5) / surface_->width(), (y + 0.5) / surface_->height());
}

void SpatialEvaluator::eval(const Place& place, Vec3 wi, Vec3 wo, std::span<float> f) const noexcept {
  lobes_.eval(place.frame.local(wi), place.frame.local(wo),
              std::span(place.weights).first(LobeEvaluator::kWeightStride * lobes_.lobes()), f);
}

}  // namespace burnish
