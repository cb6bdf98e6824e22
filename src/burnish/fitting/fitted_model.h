// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include <burnish/baselines/baseline_file.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/fitting/fit_report.h>

namespace burnish {

/// The result of one form of fit, before it is scored: a model, and the part of the report that says how it came to be.
struct FittedModel {
  std::variant<FactoredBrdf, BaselineBrdf> brdf;
  decltype(FitReport::how) how;
  std::optional<BudgetChoice> budget_choice = {};  ///< where the number of bytes was chosen
};

/// One lobe, fitted log-linearly.
struct FittedLobe {
  FactoredBrdf brdf;
  OneLobeReport report;
};

/// Several lobes, refined together, or one with a volume.
struct FittedLobes {
  FactoredBrdf brdf;
  LobesReport report;
};

}  // namespace burnish
