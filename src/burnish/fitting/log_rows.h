#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/homomorphic.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// A block of samples as rows of the log-linear problem: what each lookup touches, the logarithms and the
/// weights. Samples without weight are left out.
struct LogRows {
  std::size_t size = 0;
  std::vector<std::uint32_t> node;  ///< [sample][use], lower corner
  std::vector<float> fx, fy;        ///< [sample][use]
  std::vector<float> target;        ///< [sample][channel]
  std::vector<float> weight;        ///< [sample]
};

/// How samples become rows.
struct RowMaker {
  const SampleSource* source;
  const ModelSpec* spec;  ///< one lobe
  double floor;           ///< see HomomorphicOptions

  /// The rows of samples [begin, end).
  LogRows make(std::size_t begin, std::size_t end) const;
};

/// Where a table's unknowns stand in the vector of all: base[t] + node * channels[t] + channel.
struct Unknowns {
  std::vector<std::size_t> base;
  std::vector<std::size_t> channels;  ///< 1 for a shared table
  std::size_t count = 0;
};

Unknowns number_unknowns(const ModelSpec& spec, int channels);

/// Solution of a log-linear problem.
struct LogSolution {
  std::vector<double> log_values;      ///< as numbered by Unknowns
  std::vector<double> channel_offset;  ///< added to every log value of a channel
  std::size_t samples = 0;
  double error_before = 0, error_after = 0;  ///< see HomomorphicSummary
  int iterations = 0;
  std::string stop_reason;
};

/// Minimizes by gathering the normal equations in one pass and factorizing them: for up to a thousand
/// unknowns.
LogSolution solve_directly(const RowMaker& rows, const Unknowns& unknowns, const HomomorphicOptions& options);

/// Minimizes by conjugate gradients on the normal equations, without forming them.
LogSolution solve_iteratively(const RowMaker& rows, const Unknowns& unknowns,
                              const HomomorphicOptions& options);

}  // namespace burnish
