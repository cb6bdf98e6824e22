// SPDX-License-Identifier: Apache-2.0
#include <burnish/fitting/fit_summary.h>

namespace burnish {

std::string_view to_string(StopReason reason) noexcept {
  switch (reason) {
    case StopReason::direct_solution:
      return "direct solution";
    case StopReason::tolerance_reached:
      return "tolerance reached";
    case StopReason::no_more_progress:
      return "no more progress";
    case StopReason::converged:
      return "converged";
    case StopReason::iteration_limit:
      return "iteration limit";
  }
  return {};
}

}  // namespace burnish
