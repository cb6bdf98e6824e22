#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <burnish/fitting/choosing/lobe_plan.h>

namespace burnish {

/// One way to change a plan; nothing where it does not apply.
struct PlanChange {
  std::string name;
  std::function<std::optional<LobePlan>(const LobePlan&)> apply;
};

/// The changes that search_plan tries of a plan: one lobe more or fewer; of each factor a larger or smaller share,
/// another warp, one table for all lobes, and none; factors over further projections; other coefficients of theirs.
std::vector<PlanChange> list_changes(const LobePlan& plan);

}  // namespace burnish
