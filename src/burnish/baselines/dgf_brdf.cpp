// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include <burnish/baselines/dgf_brdf.h>
#include <burnish/error.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

namespace {

constexpr float kMaxConstant = 1e30f;  // within it no product overflows

void check_constants(std::span<const float> constants, const char* name) {
  for (const float c : constants)
    if (!(c >= 0 && c <= kMaxConstant))
      throw Error(fmt::format("dgf: {}: expected a number in [0, {}], found {}", name, kMaxConstant, c));
}

void check_factor(const NodeTable& table, PairCoordinate coordinate, std::size_t channels, const char* name) {
  check_node_table(table, channels, name);
  if (table.axes.size() != 1 || table.axes[0].coordinate != coordinate || table.terms != 1)
    throw Error(
        fmt::format("table '{}': expected one term over {}, found others", name, to_string(coordinate)));
  for (const float value : table.values)
    if (value < 0) throw Error(fmt::format("table '{}': expected values >= 0, found {}", name, value));
}

}  // namespace

DgfBrdf::DgfBrdf(std::vector<float> diffuse, std::vector<float> scale, NodeTable d, NodeTable g, NodeTable f)
    : diffuse_(std::move(diffuse)),
      scale_(std::move(scale)),
      d_(std::move(d)),
      g_(std::move(g)),
      f_(std::move(f)) {
  if (diffuse_.empty() || diffuse_.size() > SymmetrizedBrdf::kMaxChannels || scale_.size() != diffuse_.size())
    throw Error(fmt::format("dgf: expected one diffuse and one scale a channel, at most {}, found {} and {}",
                            SymmetrizedBrdf::kMaxChannels, diffuse_.size(), scale_.size()));
  check_constants(diffuse_, "diffuse");
  check_constants(scale_, "scale");
  check_factor(d_, PairCoordinate::theta_h, channels(), "d");
  check_factor(g_, PairCoordinate::theta_d, channels(), "g");
  check_factor(f_, PairCoordinate::theta_d, channels(), "f");
}

double microfacet_divisor(Vec3 wi, Vec3 wo) noexcept {
  return std::max(wi.z * wo.z, kDrawnCosine * kDrawnCosine);
}

bool DgfBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::fill(f.begin(), f.end(), 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;
  // D over theta_h, F over theta_d, and the masking G of either direction
  const PairPlace place(wi, wo);
  const NodeCorners in_d = corners(d_.axes, place), in_f = corners(f_.axes, place),
                    in_gi = corners(g_.axes, masking_place(wi)), in_go = corners(g_.axes, masking_place(wo));
  const double divisor = microfacet_divisor(wi, wo);
  const auto value = [](const NodeTable& table, const NodeCorners& at, std::size_t c) {
    return node_value(table, at, table.channels == 1 ? 0 : c, 0);
  };
  for (std::size_t c = 0; c < f.size(); ++c) {
    const double masking = value(g_, in_gi, c) * value(g_, in_go, c);
    f[c] = diffuse_[c] + scale_[c] * value(d_, in_d, c) * value(f_, in_f, c) * masking / divisor;
  }
  return true;
}

std::size_t DgfBrdf::bytes() const noexcept {
  return 2 * (d_.values.size() + g_.values.size() + f_.values.size()) +
         sizeof(float) * (diffuse_.size() + scale_.size());
}

}  // namespace burnish
