// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// A block of samples as rows of the log-linear problem: the texels of each lookup, the logarithms and the weights.
/// Samples without weight are left out.
struct LogRows {
  std::size_t size = 0;
  std::vector<std::uint32_t> node;  ///< [sample][use], lower corner
  std::vector<float> fx, fy, fz;    ///< [sample][use]
  std::vector<float> target;        ///< [sample][channel]
  std::size_t weight_channels = 1;  ///< one weight for all channels, or one each
  std::vector<float> weight;        ///< [sample]
};

/// Makes rows of samples. Without a current model, the rows are log(f + floor) with the samples' weights.
/// With one, they are a step of reweighted least squares for the absolute error of log(f + error_floor) about that
/// model. The error's derivative by log(model) is model / (model + error_floor). A square weighs like an absolute
/// value where it is divided by the size of the current error [Daubechies 2010].
class RowMaker {
 public:
  RowMaker(const SampleSource& samples, const ModelSpec& model, double fit_floor,
           double floor_of_error) noexcept
      : source(&samples), spec(&model), floor(fit_floor), error_floor(floor_of_error) {}

  const SampleSource* source;
  const ModelSpec* spec;      ///< one lobe
  double floor, error_floor;  ///< see HomomorphicOptions
  double backscatter = 0;     ///< see HomomorphicOptions

  const FactoredBrdf* current = nullptr;

  /// Returns the rows of samples [begin, end).
  LogRows make(std::size_t begin, std::size_t end) const;

 private:
  double emphasis(const DirectionPair& pair) const noexcept;
  void add_plain(std::span<const double> f, double weight, LogRows& rows) const;
  void add_reweighted(const DirectionPair& pair, std::span<const double> f, double weight,
                      std::span<double> model, LogRows& rows) const;
};

/// Solution of a log-linear problem.
struct LogSolution {
  std::vector<double> log_values;      ///< as number_nodes numbers them, a copy a channel
  std::vector<double> channel_offset;  ///< added to every log value of a channel
  std::size_t samples = 0;
  FitSummary summary;  ///< see HomomorphicFit
};

}  // namespace burnish
