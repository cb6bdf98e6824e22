// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/samples.h>
#include <burnish/source.h>

#include "report.h"

namespace burnish::reports {

/// The paints of the original paper, with 1439 scattered directions each.
inline constexpr std::array<const char*, 3> kPaints = {"cayman", "mystique", "krylon_blue"};

/// Reads one paint and averages its bands to three: 400 to 490, 500 to 590, 600 to 700 nm.
Samples read_paint(const fs::path& data, const char* name);

inline constexpr std::size_t kFolds = 5;

/// The rows to fit and the rows to test. Row i is tested in fold i mod kFolds.
struct Fold {
  std::vector<std::size_t> training, test;
};
Fold split_fold(std::size_t rows, std::size_t fold);

/// The paper's model with the further factors r(theta_d) and m(theta_m).
inline constexpr const char* kScatteredModel = "p(wo) q(h) m(theta_m) r(theta_d) p(wi)";

/// Opens samples as `burnish fit` does.
Source source_of(Samples samples);

/// Fits one lobe. Smoothness is chosen by cross-validation among the samples of the source.
FactoredBrdf fit_scattered(const Source& source, const std::string& expression);

/// The errors of the tested rows of all folds, at the floors 1e-3 and 1e-5.
struct FoldErrors {
  std::array<double, 2> sum{}, sum_sq{};  ///< of |ln((f + floor) / (model + floor))| and of its square
  std::size_t count = 0;

  void add(std::span<const double> f, std::span<const double> model);
  double relative(std::size_t floor) const;
  double rms_log(std::size_t floor) const;
};

}  // namespace burnish::reports
