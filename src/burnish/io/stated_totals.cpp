// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <burnish/io/stated_totals.h>
#include <burnish/math/angles.h>
#include <burnish/math/luminance.h>
#include <burnish/metrics/albedo.h>

namespace burnish {

namespace {

constexpr double kTrustedTotal = 0.05;  // relative to the total; allows for quadrature and rounding
constexpr double kMostTotalTheta = radians(85);

/// Returns the luminance of one channel or of three, the mean of others.
double single_total(const std::vector<double>& values) noexcept {
  if (values.size() == 3) return luminance({values[0], values[1], values[2]});
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Returns the integrals of all channels at one azimuth and polar angle of the light.
std::vector<double> integrals(const AngleTable& table, std::size_t azimuth, std::size_t incidence,
                              double accuracy) {
  const Vec3 wi = spherical_direction(table.axes[1].nodes[incidence], table.axes[0].nodes[azimuth]);
  return directional_albedo(table, wi, accuracy).albedo;
}

/// Scales each of `lanes` groups of channels (one group, or each channel apart) at each incidence. `name` is that of
/// the totals in the file.
void scale_lanes(AngleTable& table, std::span<const double> stated, std::size_t lanes, std::string_view name,
                 Findings& findings) {
  const std::size_t incidences = table.axes[1].nodes.size(), channels = table.channel_count;
  const std::size_t blocks = table.axes[0].nodes.size() * incidences, block = table.values.size() / blocks;
  std::vector<double> factors(blocks * lanes, 1.0);
  for (std::size_t b = 0; b < blocks; ++b) {
    std::vector<double> found(lanes, 0.0);
    if (table.axes[1].nodes[b % incidences] <= kMostTotalTheta) {
      const std::vector<double> all = integrals(table, b / incidences, b % incidences, kAlbedoTolerance);
      found = lanes == 1 ? std::vector{single_total(all)} : all;
    }
    for (std::size_t k = 0; k < lanes; ++k)
      if (found[k] > 0 && stated[b * lanes + k] > 0)
        factors[b * lanes + k] = stated[b * lanes + k] / found[k];
      else if (b % incidences > 0)
        factors[b * lanes + k] = factors[(b - 1) * lanes + k];
  }
  for (std::size_t k = 0; k < table.values.size(); ++k)
    table.values[k] = static_cast<float>(static_cast<double>(table.values[k]) *
                                         factors[k / block * lanes + (lanes == 1 ? 0 : k % channels)]);
  findings.most_negative *= std::ranges::max(factors);
  findings.conventions.push_back(fmt::format("The values were scaled to {}, by {:.4g} to {:.4g}.", name,
                                             std::ranges::min(factors), std::ranges::max(factors)));
}

}  // namespace

void check_totals(const AngleTable& table, std::span<const double> stated, Findings& findings) {
  constexpr std::size_t kMostIncidences = 4;
  constexpr double kAccuracy = 0.02;
  const std::vector<double>& incidences = table.axes[1].nodes;
  const std::size_t step = (incidences.size() + kMostIncidences - 1) / kMostIncidences;
  double worst = 0, worst_found = 0;
  std::size_t worst_at = 0, compared = 0;
  for (std::size_t i = 0; i < incidences.size(); i += step) {
    if (!(stated[i] > 0) || incidences[i] > kMostTotalTheta) continue;
    const double found = single_total(integrals(table, 0, i, kAccuracy));
    ++compared;
    const double off = std::abs(found - stated[i]) / std::max(stated[i], kTrustedTotal);
    if (off > worst) worst = off, worst_found = found, worst_at = i;
  }
  if (worst > kTrustedTotal)
    findings.warnings.push_back(fmt::format(
        "The values integrate to {:.3g} % at theta_i = {:.3g} degrees, TIS says {:.3g} %: taken as they are "
        "(--scale-to-tis scales them).",
        100 * worst_found, degrees(incidences[worst_at]), 100 * stated[worst_at]));
  else if (compared > 0)
    findings.conventions.push_back("The values integrate to the stated TIS.");
}

void scale_to_totals(AngleTable& table, std::span<const double> stated, Findings& findings) {
  scale_lanes(table, stated, 1, "TIS", findings);
}

void scale_channels_to_totals(AngleTable& table, std::span<const double> stated, Findings& findings) {
  scale_lanes(table, stated, table.channel_count, "kbdf", findings);
}

}  // namespace burnish
