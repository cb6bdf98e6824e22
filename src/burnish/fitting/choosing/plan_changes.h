// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <burnish/fitting/choosing/lobe_plan.h>

namespace burnish {

/// One way to change a plan. `apply` returns nothing if the change does not apply.
struct PlanChange {
  std::string name;
  std::function<std::optional<LobePlan>(const LobePlan&)> apply;
};

/// Returns the changes that search_plan tries: one lobe more or fewer; for each factor a larger or smaller share,
/// another warp, one table for all lobes, or its removal; factors over further projections; other coefficients of
/// these projections.
std::vector<PlanChange> list_changes(const LobePlan& plan);

}  // namespace burnish
