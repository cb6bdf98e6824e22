// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/reflectance/pair_error.h>

namespace burnish {

PairError pair_error(const DirectionPair& pair, std::span<const double> reference,
                     std::span<const double> model, double floor) noexcept {
  PairError error{pair};
  const std::size_t channels = std::max(reference.size(), model.size());
  for (std::size_t c = 0; c < channels; ++c) {
    const double f = std::max(0.0, reference[reference.size() == 1 ? 0 : c]);
    const double g = std::max(0.0, model[model.size() == 1 ? 0 : c]);
    error.log_cos += std::abs(std::log1p(f * pair.wi.z) - std::log1p(g * pair.wi.z));
    // Equal values are no error, even zeros without a floor.
    const double ratio = f == g ? 0 : std::log((f + floor) / (g + floor));
    error.log_ratio += std::abs(ratio);
    error.log_ratio_sq += ratio * ratio;
    error.difference_sq += (f - g) * (f - g);
    if (f > 0 && g > 0) {
      error.abs_log += std::abs(std::log(f / g));
      ++error.positive_channels;
    }
  }
  const auto count = static_cast<double>(channels);
  error.log_cos /= count;
  error.log_ratio /= count;
  error.log_ratio_sq /= count;
  error.difference_sq /= count;
  if (error.positive_channels > 0) error.abs_log /= error.positive_channels;
  return error;
}

}  // namespace burnish
