// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <burnish/math/kd_tree.h>
#include <burnish/reflectance/log_covariance.h>

namespace burnish {

/// Measured logarithms at places among the coordinates of LogCovariance.
struct LogMeasurements {
  std::size_t channels = 0;
  std::vector<TreePoint> places;
  std::vector<double> grazing;    ///< grazing_measure of each place; none: 0
  std::vector<double> logs;       ///< less the mean of each channel, [place][channel]
  std::vector<double> variances;  ///< of the noise, in units of noise^2

  std::size_t size() const noexcept { return places.size(); }
};

/// The covariance under which the measurements of each block are likeliest, blocks taken as independent, beside a prior
/// that keeps parameters within a factor of e^4 of the default. Found by steps whose sizes follow the signs of the
/// gradient [Riedmiller 1993]. The cost is that of a few dense matrices of the size of each block a step.
/// Deterministic, whatever the number of threads.
LogCovariance likeliest_covariance(const LogMeasurements& measured,
                                   std::span<const std::vector<std::size_t>> blocks, bool isotropic);

}  // namespace burnish
