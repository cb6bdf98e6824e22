// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <burnish/fitting/choosing/plan_changes.h>

namespace burnish {

namespace {

PlannedFactor* find(LobePlan& plan, const std::string& name) {
  const auto at = std::ranges::find(plan.factors, name, &PlannedFactor::name);
  return at == plan.factors.end() ? nullptr : &*at;
}

double mean_share(const LobePlan& plan) {
  double sum = 0;
  for (const PlannedFactor& f : plan.factors) sum += f.share;
  return sum / static_cast<double>(plan.factors.size());
}

// Projections that the default plans do not have. A list of two holds one for either order of the directions.
std::vector<std::pair<std::string, std::vector<Projection>>> further_projections() {
  std::vector<std::pair<std::string, std::vector<Projection>>> list;
  for (const double n : {-0.5, 0.5, 2.0}) list.push_back({"t", {Projection{.wi = 1, .wo = 1, .n = n}}});
  for (const double b : {-0.5, 0.5})
    list.push_back({"t", {Projection{.wi = 1, .wo = b}, Projection{.wi = b, .wo = 1}}});
  list.push_back(
      {"t", {Projection{.wi = 1, .wo = -0.5, .n = 0.5}, Projection{.wi = -0.5, .wo = 1, .n = 0.5}}});
  return list;
}

std::vector<PlanChange> changes_of_lobes() {
  std::vector<PlanChange> changes;
  for (const int step : {1, -1})
    changes.push_back(
        {step > 0 ? "one lobe more" : "one lobe fewer", [step](LobePlan p) -> std::optional<LobePlan> {
           p.lobes += step;
           if (p.lobes < 1) return {};
           return p;
         }});
  return changes;
}

std::vector<PlanChange> changes_of_factor(const std::string& name) {
  std::vector<PlanChange> changes;
  for (const double scale : {1.5, 0.67})
    changes.push_back(
        {fmt::format("share of {} x {}", name, scale), [=](LobePlan p) -> std::optional<LobePlan> {
           PlannedFactor* f = find(p, name);
           if (!f || p.factors.size() < 2) return {};
           f->share *= scale;
           return p;
         }});
  for (const Warp warp : {Warp{}, Warp{WarpKind::power, 0.5}, Warp{WarpKind::power, 0.7},
                          Warp{WarpKind::rational, 0.1}, Warp{WarpKind::rational, -1.3}})
    changes.push_back(
        {fmt::format("{} spaced {}", name, to_string(warp)), [=](LobePlan p) -> std::optional<LobePlan> {
           PlannedFactor* f = find(p, name);
           if (!f || f->warp == warp) return {};
           f->warp = warp;
           return p;
         }});
  changes.push_back({fmt::format("one {} for all lobes", name), [=](LobePlan p) -> std::optional<LobePlan> {
                       PlannedFactor* f = find(p, name);
                       const auto own = std::ranges::count(p.factors, false, &PlannedFactor::every_lobe);
                       if (!f || f->every_lobe || p.lobes < 2 || own < 2) return {};
                       f->every_lobe = true;
                       return p;
                     }});
  changes.push_back({fmt::format("without {}", name), [=](LobePlan p) -> std::optional<LobePlan> {
                       if (p.factors.size() < 3 || !find(p, name)) return {};
                       std::erase_if(p.factors, [&](const PlannedFactor& f) { return f.name == name; });
                       return p;
                     }});
  return changes;
}

std::vector<PlanChange> changes_by_projections() {
  std::vector<PlanChange> changes;
  for (const auto& [name, uses] : further_projections())
    changes.push_back({fmt::format("with {}({})", name, to_string(uses.front())),
                       [added = name, along = uses](LobePlan p) -> std::optional<LobePlan> {
                         if (find(p, added)) return {};
                         p.factors.push_back({added, TableShape::line, along, 0.4 * mean_share(p), {}});
                         return p;
                       }});
  return changes;
}

std::vector<PlanChange> changes_of_coefficients() {  // for projections between directions
  std::vector<PlanChange> changes;
  for (const char* name : {"s", "t"})
    for (const double scale : {1.4, 0.7})
      changes.push_back(
          {fmt::format("coefficients of {} x {}", name, scale), [=](LobePlan p) -> std::optional<LobePlan> {
             PlannedFactor* f = find(p, name);
             if (!f) return {};
             if (f->uses.size() == 2) {
               f->uses[0].wo *= scale;
               f->uses[1].wi *= scale;
             } else {
               f->uses[0].n *= scale;
             }
             return p;
           }});
  return changes;
}

}  // namespace

std::vector<PlanChange> list_changes(const LobePlan& plan) {
  std::vector<PlanChange> changes = changes_of_lobes();
  const auto add = [&](std::vector<PlanChange> further) {
    std::ranges::move(further, std::back_inserter(changes));
  };
  for (const PlannedFactor& factor : plan.factors) add(changes_of_factor(factor.name));
  add(changes_by_projections());
  add(changes_of_coefficients());
  return changes;
}

}  // namespace burnish
