// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <burnish/error.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/fitting/refinement/log_model.h>

namespace burnish {

namespace {

// The step that splits a lobe, over tan(theta_d / 2): its width, and the share that is left far away.
constexpr double kStepWidth = 0.1, kStepRest = 0.01;

// A logistic step from kStepRest to 1 - kStepRest at `centre`.
double step_up(double t, double centre) {
  return kStepRest + (1 - 2 * kStepRest) / (1 + std::exp((centre - t) / kStepWidth));
}

// Returns the coordinate of a node: its index over the last one, through the inverse warp.
double node_place(const Warp& warp, int node, int count) {
  return warp.inverse(static_cast<double>(node) / (count - 1));
}

struct Cell {
  std::size_t node;
  double fraction;
};

Cell find_cell(double u, int count) {
  const double position = std::clamp(u, 0.0, 1.0) * (count - 1);
  const auto node = std::min(static_cast<std::size_t>(position), static_cast<std::size_t>(count - 2));
  return {node, position - static_cast<double>(node)};
}

}  // namespace

LogModel fit_one_lobe(const ModelSpec& spec, const TrainingSet& set, const std::vector<float>& values,
                      const HomomorphicOptions& options) {
  // The fit is in single precision, so that the refinement that follows starts from unrounded values.
  ModelSpec unrounded = spec;
  for (ModelSpec::TableSpec& table : unrounded.tables) table.format = TableFormat::single;
  const HomomorphicFit fit = fit_homomorphic(as_source(set, values), unrounded, options);
  LogModel model{.spec = spec, .channels = set.channels, .log_values = {}};
  for (const Table& table : fit.brdf.tables()) {
    auto& logs = model.log_values.emplace_back(table.values.begin(), table.values.end());
    for (double& v : logs) v = std::log(v);
  }
  // The lobe's scale goes into its last table with all channels. A table used n times takes 1/n of the logarithm.
  const Lobe& lobe = fit.brdf.lobes().front();
  for (std::size_t k = lobe.factors.size(); k-- > 0;) {
    const auto t = lobe.factors[k].table;
    const auto uses = std::ranges::count(lobe.factors, lobe.factors[k].table, &FactorUse::table);
    if (model.step(t) != model.channels) continue;
    for (std::size_t i = 0; i < model.log_values[t].size(); ++i)
      model.log_values[t][i] +=
          std::log(std::max(lobe.scale[i % model.step(t)], 1e-30)) / static_cast<double>(uses);
    return model;
  }
  throw Error("fit: expected a table with all channels in every lobe, found shared ones alone");
}

LogModel with_lobe_split(LogModel model, std::size_t lobe, double centre, const std::string& suffix,
                         std::span<const std::string> common) {
  const auto is_common = [&](std::size_t table) {
    return std::ranges::find(common, model.spec.tables[table].name) != common.end();
  };
  // The new lobe gets copies of its own tables. The first table over theta_d is multiplied by the step s in the copy,
  // and by 1 - s in the old lobe: the two add up to the old lobe.
  std::vector<FactorUse> uses = model.spec.lobes[lobe];
  std::vector<std::optional<std::size_t>> copy(model.spec.tables.size());
  bool stepped = false;
  for (FactorUse& use : uses) {
    const auto t = use.table;
    if (is_common(use.table)) continue;
    if (!copy[t]) {
      copy[t] = model.spec.tables.size();
      model.spec.tables.push_back(model.spec.tables[t]);
      model.spec.tables.back().name += suffix;
      model.log_values.push_back(model.log_values[t]);
      const TableLayout& layout = model.spec.tables[t].layout;
      if (!stepped && layout.shape == TableShape::line && use.projection == kProjectDifference) {
        stepped = true;
        const std::size_t step = model.step(t);
        for (std::size_t i = 0; i < model.log_values[t].size(); ++i) {
          const double up =
              step_up(node_place(layout.warp, static_cast<int>(i / step), layout.width), centre);
          model.log_values.back()[i] += std::log(up);
          model.log_values[t][i] += std::log(1 - up);
        }
      }
    }
    use.table = *copy[t];
  }

  // Without such a table both lobes are halved, in a table of their own.
  const std::vector<FactorUse>& old = model.spec.lobes[lobe];
  const auto own = std::ranges::find_if(old, [&](const FactorUse& use) { return !is_common(use.table); });
  if (!stepped)
    for (const std::size_t table : {own->table, uses[static_cast<std::size_t>(own - old.begin())].table}) {
      const auto times = std::ranges::count(old, own->table, &FactorUse::table);
      for (double& v : model.log_values[table]) v -= std::log(2) / static_cast<double>(times);
    }
  model.spec.lobes.push_back(std::move(uses));
  return model;
}

namespace {

// Adds the logarithm of the function that one table holds to the nodes of another.
void add_resampled(const TableLayout& from, const std::vector<double>& old, const TableLayout& to,
                   std::size_t step, std::vector<double>& logs) {
  const auto width = static_cast<std::size_t>(from.width), height = static_cast<std::size_t>(from.height);
  const int axes = axis_count(to.shape);
  std::size_t node = 0;
  for (int z = 0; z < to.depth; ++z)
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x, ++node) {
        // A node's position in the new table is unwarped, then warped to its cell in the old one.
        Cell cx{}, cy{}, cz{};
        if (to.shape == TableShape::disk) {
          const DiskPoint p = to_disk(node_direction(to, x, y), from.warp);
          cx = find_cell(0.5 + 0.5 * p.x, from.width);
          cy = find_cell(0.5 + 0.5 * p.y, from.height);
        } else {
          cx = find_cell(from.warp.forward(node_place(to.warp, x, to.width)), from.width);
          if (axes > 1) cy = find_cell(from.warp_y.forward(node_place(to.warp_y, y, to.height)), from.height);
          if (axes > 2) cz = find_cell(from.warp_z.forward(node_place(to.warp_z, z, to.depth)), from.depth);
        }
        for (std::size_t c = 0; c < step; ++c) {
          // Values, not logarithms, are interpolated, as evaluation does.
          const auto at = [&](std::size_t i, std::size_t row) {
            return std::exp(old[(row * width + i) * step + c]);
          };
          const auto along = [&](std::size_t row) {
            return (1 - cx.fraction) * at(cx.node, row) + cx.fraction * at(cx.node + 1, row);
          };
          const auto across = [&](std::size_t row) {
            const double v = along(row);
            return axes > 1 ? (1 - cy.fraction) * v + cy.fraction * along(row + 1) : v;
          };
          double v = across(cz.node * height + cy.node);
          if (axes > 2) v = (1 - cz.fraction) * v + cz.fraction * across((cz.node + 1) * height + cy.node);
          logs[node * step + c] += std::log(v);
        }
      }
}

// Returns the mean over the channels of a table's logarithms. Each channel's mean deviation from it is added to
// `colour`.
std::vector<double> mean_of_channels(const std::vector<double>& logs, std::size_t channels,
                                     std::span<double> colour) {
  std::vector<double> mean(logs.size() / channels);
  for (std::size_t i = 0; i < logs.size(); ++i) mean[i / channels] += logs[i] / static_cast<double>(channels);
  for (std::size_t i = 0; i < logs.size(); ++i)
    colour[i % channels] += (logs[i] - mean[i / channels]) / static_cast<double>(mean.size());
  return mean;
}

// Multiplies each lobe by a colour as often as it uses the table, in a coloured table of the lobe's own.
void give_colour(std::size_t table, std::span<const double> colour, LogModel& model) {
  const auto uses_in = [&](const std::vector<FactorUse>& lobe, std::size_t t) {
    return std::ranges::count(lobe, t, &FactorUse::table);
  };
  for (const std::vector<FactorUse>& lobe : model.spec.lobes) {
    const auto times = uses_in(lobe, table);
    const auto own = std::ranges::find_if(lobe, [&](const FactorUse& use) {
      return model.step(use.table) == colour.size() &&
             std::ranges::all_of(model.spec.lobes, [&](const auto& other) {
               return &other == &lobe || uses_in(other, use.table) == 0;
             });
    });
    if (times == 0 || own == lobe.end()) continue;
    const double share = static_cast<double>(times) / static_cast<double>(uses_in(lobe, own->table));
    std::vector<double>& logs = model.log_values[own->table];
    for (std::size_t i = 0; i < logs.size(); ++i) logs[i] += share * colour[i % colour.size()];
  }
}

}  // namespace

LogModel resampled(const LogModel& model, const ModelSpec& spec) {
  LogModel result{.spec = spec, .channels = model.channels, .log_values = {}};
  const auto channels = model.channels;
  for (std::size_t t = 0; t < spec.tables.size(); ++t)
    result.log_values.emplace_back(spec.tables[t].layout.node_count() * result.step(t));
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    const TableLayout& layout = spec.tables[t].layout;
    const std::string& name = spec.tables[t].name;
    // A table is found by its name, or by the first lobe's numbered name where it becomes common to all lobes.
    auto old = std::ranges::find(model.spec.tables, name, &ModelSpec::TableSpec::name);
    if (old == model.spec.tables.end())
      old = std::ranges::find(model.spec.tables, name + "1", &ModelSpec::TableSpec::name);
    if (old == model.spec.tables.end() || old->layout.shape != layout.shape) continue;
    const auto k = static_cast<std::size_t>(old - model.spec.tables.begin());
    const std::size_t step = result.step(t);
    // Tables of equal channels are resampled. One that becomes shared takes the mean, and the lobes get its colour.
    if (model.step(k) == step) {
      add_resampled(old->layout, model.log_values[k], layout, step, result.log_values[t]);
    } else if (step == 1) {
      std::vector<double> colour(channels);
      const std::vector<double> mean = mean_of_channels(model.log_values[k], channels, colour);
      add_resampled(old->layout, mean, layout, 1, result.log_values[t]);
      give_colour(t, colour, result);
    }
  }
  return result;
}

std::vector<Table> log_tables(const LogModel& model, TableFormat format) {
  std::vector<Table> tables;
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t)
    tables.push_back({.name = model.spec.tables[t].name,
                      .layout = model.spec.tables[t].layout,
                      .channels = model.step(t),
                      .values = {model.log_values[t].begin(), model.log_values[t].end()},
                      .format = format_of(model.spec.tables[t], format)});
  return tables;
}

std::vector<Lobe> log_scaled_lobes(const LogModel& model) {
  std::vector<Lobe> lobes;
  for (const std::vector<FactorUse>& uses : model.spec.lobes)
    lobes.push_back({.scale = std::vector<double>(model.channels), .factors = uses});
  return lobes;
}

FactoredBrdf to_brdf(const LogModel& model, TableFormat format) {
  return from_log_tables(model.channels, log_tables(model, format), log_scaled_lobes(model));
}

}  // namespace burnish
