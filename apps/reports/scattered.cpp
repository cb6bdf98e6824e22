// SPDX-License-Identifier: Apache-2.0
#include "scattered.h"

#include <algorithm>
#include <cmath>

#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/cornell.h>

namespace burnish::reports {

namespace {

Samples three_bands(const SampleFile& file) {
  Samples result{.channels = 3, .isotropic = true, .pairs = file.samples.pairs};
  for (std::size_t i = 0; i < file.samples.size(); ++i) {
    std::array<double, 3> sum{}, count{};
    for (std::size_t k = 0; k < file.findings.lambda_nm.size(); ++k) {
      const double lambda_nm = file.findings.lambda_nm[k];
      const std::size_t band = lambda_nm < 495 ? 0 : lambda_nm < 595 ? 1 : 2;
      sum[band] += file.samples.at(i)[k];
      ++count[band];
    }
    for (std::size_t b = 0; b < 3; ++b) result.values.push_back(sum[b] / count[b]);
  }
  return result;
}

}  // namespace

Samples read_paint(const fs::path& data, const char* name) {
  return three_bands(
      parse_cornell(read_file(data / "cornell" / (std::string(name) + ".brdf")), {.keep_spectral = true}));
}

Fold split_fold(std::size_t rows, std::size_t fold) {
  Fold split;
  for (std::size_t i = 0; i < rows; ++i) (i % kFolds == fold ? split.test : split.training).push_back(i);
  return split;
}

Source source_of(Samples samples) {
  return {.name = {}, .brdf = ScatteredBrdf(std::move(samples)), .findings = {}};
}

FactoredBrdf fit_scattered(const Source& source, const std::string& expression) {
  std::vector<std::string> tables{"p=48", "q=64,rational:0.2"};
  if (expression != "pqp") tables.push_back("r=32");
  if (expression.find('m') != expression.npos) tables.push_back("m=48,power:0.5");
  return fit(source, {.form = OneLobe{.model = expression, .tables = tables}, .score = false}).model();
}

void FoldErrors::add(std::span<const double> f, std::span<const double> model) {
  constexpr std::array<double, 2> kFloors{1e-3, 1e-5};
  for (std::size_t c = 0; c < f.size(); ++c, ++count)
    for (std::size_t k = 0; k < 2; ++k) {
      const double error = std::abs(std::log((std::max(f[c], 0.0) + kFloors[k]) / (model[c] + kFloors[k])));
      sum[k] += error;
      sum_sq[k] += error * error;
    }
}

double FoldErrors::relative(std::size_t floor) const {
  return std::expm1(sum[floor] / static_cast<double>(count));
}

double FoldErrors::rms_log(std::size_t floor) const {
  return std::sqrt(sum_sq[floor] / static_cast<double>(count));
}

}  // namespace burnish::reports
