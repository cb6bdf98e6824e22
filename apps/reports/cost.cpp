// SPDX-License-Identifier: Apache-2.0
// Measures the cost and the error of an evaluation: fits by bytes and fetches, and the usual alternatives.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/eval/evaluation_peers_bench.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/shaders/shader.h>

#include "accuracy_scores.h"
#include "cost_sources.h"
#include "evaluation_times.h"
#include "frames.h"
#include "peer_shaders.h"
#include "report.h"

namespace burnish::reports {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The cost and the error of one way to store a material. Figures that it does not have are kNone.
struct Row {
  std::string method;
  std::size_t budget = 0;  // 0: no limit
  int asked = 0;           // fetches that a fit may take
  double bytes = kNone, psnr = kNone, relative = kNone;
  double fetches = kNone, textures = kNone, operations = kNone, roots = kNone;
  double one_by_one = kNone, batched = kNone;  // ns
  double frame = kNone, of_ggx = kNone;        // ms, and relative to that of GGX
  double seconds = kNone;                      // time of the fit
};

struct Column {
  const char *head, *format;
  double Row::*value;
};
constexpr Column kColumns[] = {
    {"bytes", "{:.0f}", &Row::bytes},         {"psnr", "{:.2f}", &Row::psnr},
    {"relative", "{:.4f}", &Row::relative},   {"fetches", "{:.3g}", &Row::fetches},
    {"textures", "{:.3g}", &Row::textures},   {"operations", "{:.0f}", &Row::operations},
    {"roots", "{:.3g}", &Row::roots},         {"ns, one by one", "{:.1f}", &Row::one_by_one},
    {"ns, batched", "{:.2f}", &Row::batched}, {"ms a frame", "{:.1f}", &Row::frame},
    {"of GGX", "{:.2f}", &Row::of_ggx},       {"fit seconds", "{:.1f}", &Row::seconds},
};

std::vector<std::string> head_of_columns(std::vector<std::string> head) {
  for (const Column& column : kColumns) head.emplace_back(column.head);
  return head;
}
std::vector<std::string> cells_of(std::vector<std::string> cells, const Row& row) {
  cells.push_back(row.method);
  cells.push_back(row.budget > 0 ? std::to_string(row.budget) : "");
  cells.push_back(row.asked > 0 ? std::to_string(row.asked) : "");
  for (const Column& column : kColumns) {
    const double value = row.*column.value;
    cells.push_back(std::isnan(value) ? "" : fmt::format(fmt::runtime(column.format), value));
  }
  return cells;
}

// The sizes of the measurement.
struct Extent {
  std::vector<std::size_t> budgets;
  std::vector<int> fetches;
  std::size_t pairs;
  int turns, lights, frames;
  FigureOptions figures;
};
Extent extent_of(bool quick) {
  if (quick)
    return {.budgets = {2700},
            .fetches = {2, 4},
            .pairs = 1 << 13,
            .turns = 3,
            .lights = 1,
            .frames = 1,
            .figures = {.count = 20'000, .image_size = 64}};
  return {.budgets = {2700, 16'384, 65'536},
          .fetches = {2, 3, 4, 6, 8, 12, 24},
          .pairs = 1 << 16,
          .turns = 25,
          .lights = 16,
          .frames = 5,
          .figures = {}};
}

// All methods tried on one material, each with the functions that time it. These functions own the models that they
// time.
class Contest {
 public:
  Contest(const Material& material, const PairSet& set, const Extent& extent)
      : material_(material), set_(set), extent_(extent) {}

  /// Adds a fit for each number of fetches; the numbers rise.
  void add_fits(std::size_t budget, const std::vector<int>& fetches);
  void add_ggx();
  void add_network(const NeuralBrdf& network);
  void add_measurement();
  void add_merl();
  void add_separable(const std::string& method, std::size_t budget);

  /// Times the added methods. Frames are timed only where there is OpenGL.
  std::vector<Row> rows(bool with_frames);

 private:
  struct Entry {
    Row row;
    std::function<void()> one_by_one, batched;  // empty: none
    std::optional<FrameMaterial> frame;
    std::optional<std::size_t> same_as = {};  // an earlier entry whose times this one shares
  };

  Row row_of(const std::string& method, std::size_t bytes, BrdfRef model) const;
  Entry entry_of_fit(std::size_t budget, int asked) const;
  std::string said(const std::string& what) const { return fmt::format("{}, {}", material_.name, what); }
  void time_evaluations();
  void time_all_frames();

  const Material& material_;
  const PairSet& set_;
  const Extent& extent_;
  std::vector<Entry> entries_;
};

Row Contest::row_of(const std::string& method, std::size_t bytes, BrdfRef model) const {
  const ErrorFigures errors = material_.scorer.score(model);
  Row row{.method = method};
  row.bytes = static_cast<double>(bytes);
  row.psnr = errors.psnr;
  row.relative = errors.relative;
  return row;
}

Contest::Entry Contest::entry_of_fit(std::size_t budget, int asked) const {
  const std::string name = said(fmt::format("{} bytes, {} fetches", budget, asked));
  tell("cost: " + name);
  const Fit made =
      fit(material_.source,
          {.form = Budget{.bytes = budget, .fetches = asked}, .target = FitTarget::function, .score = false});
  const auto model = std::make_shared<const FactoredBrdf>(made.model());
  const auto evaluator = std::make_shared<const FactoredEvaluator>(*model);
  Row row = row_of("ours", model->bytes(), *model);
  row.budget = budget;
  row.asked = asked;
  const ShaderCost cost = generate_shader(*model, {.filter = ShaderFilter::hardware}).cost;
  row.fetches = static_cast<double>(fetch_count(*model));
  row.textures = cost.textures;
  row.operations = cost.operations;
  row.roots = cost.roots;
  row.seconds = made.report.seconds;
  const auto run = [model, evaluator](const DirectionSpans& in, std::span<float> f) {
    evaluator->eval(in, f);
  };
  return {.row = row,
          .one_by_one = one_by_one(set_, evaluator),
          .batched = batched(name, set_, run, *model, evaluator->rounding_bound()),
          .frame = FrameMaterial{name, surface_shader(*model, ShaderFilter::hardware, TableFormat::rgb9e5),
                                 *model}};
}

// Fits from the most fetches to the least. Plans take tables in one order while there are fetches (fetch_plan.h). A fit
// that needs no more than a smaller number is therefore, bit by bit, the fit with that number. It is neither fitted nor
// timed again.
void Contest::add_fits(std::size_t budget, const std::vector<int>& fetches) {
  const std::size_t first = entries_.size();
  entries_.resize(first + fetches.size());
  for (std::size_t k = fetches.size(); k-- > 0;) {
    Entry& entry = entries_[first + k];
    if (k + 1 < fetches.size() && entries_[first + k + 1].row.fetches <= fetches[k]) {
      const Entry& larger = entries_[first + k + 1];
      entry.row = larger.row;
      entry.row.asked = fetches[k];
      entry.same_as = larger.same_as.value_or(first + k + 1);
    } else {
      entry = entry_of_fit(budget, fetches[k]);
    }
  }
}

void Contest::add_ggx() {
  const std::string name = said("GGX");
  tell("cost: " + name);
  const Fit made = fit(material_.source, {.form = BaselineMethod{.method = "analytic:ggx"}, .score = false});
  const auto& analytic = std::get<AnalyticBrdf>(std::get<BaselineBrdf>(made.brdf));
  const auto ggx = std::make_shared<const Ggx>(std::get<Ggx>(analytic.variant()));
  Row row = row_of("GGX", analytic.bytes(), *ggx);
  row.fetches = row.textures = 0;
  row.seconds = made.report.seconds;
  const auto run = [ggx](const DirectionSpans& in, std::span<float> f) { eval_ggx(*ggx, in, f); };
  entries_.push_back({row, one_by_one(set_, ggx), batched(name, set_, run, *ggx, 1e-3),
                      FrameMaterial{name, shader_of(*ggx), *ggx}});
}

void Contest::add_network(const NeuralBrdf& network) {
  const std::string name = said("network");
  const auto kept = std::make_shared<const NeuralBrdf>(network);
  Row row = row_of("network", NeuralBrdf::bytes(), SymmetrizedBrdf(*kept));
  row.fetches = row.textures = 0;
  const auto run = [kept](const DirectionSpans& in, std::span<float> f) {
    eval_neural(kept->weights(), in, f);
  };
  entries_.push_back({row, one_by_one(set_, kept), batched(name, set_, run, *kept, 1e-2),
                      FrameMaterial{name, shader_of(*kept), *kept}});
}

// Adds the reference itself, which has no error.
void Contest::add_measurement() {
  const auto* table = std::get_if<RglTable>(&material_.source.brdf);
  if (!table) return;
  const auto kept = std::make_shared<const RglTable>(*table);
  Row row;
  row.method = "RGL table, the reference";
  entries_.push_back({row, one_by_one(set_, kept), {}, {}});
}

// Adds the table twice: with nearest entries, as its readers evaluate it, and filtered, as a texture unit would.
void Contest::add_merl() {
  const std::string name = said("MERL table");
  tell("cost: " + name);
  const auto table =
      std::make_shared<const HalfDiffTable>(tabulate_half_diff(material_.reference, 90, 90, 180, false));
  // NearestHalfDiff refers to the table, so the deleter keeps it.
  const std::shared_ptr<const NearestHalfDiff> nearest(new NearestHalfDiff{table.get()},
                                                       [table](const NearestHalfDiff* p) { delete p; });
  const std::size_t bytes = sizeof(float) * table->values.size();
  Row row = row_of("MERL table, nearest", bytes, *nearest);
  row.fetches = 1;
  const auto run = [table](const DirectionSpans& in, std::span<float> f) { eval_nearest(*table, in, f); };
  entries_.push_back({row, one_by_one(set_, nearest), batched(name, set_, run, *nearest, 0.1), {}});
  row = row_of("MERL table, filtered", bytes, *table);
  row.fetches = row.textures = 1;
  entries_.push_back({row, one_by_one(set_, table), {}, FrameMaterial{name, shader_of(*table), *table}});
}

void Contest::add_separable(const std::string& method, std::size_t budget) {
  tell("cost: " + said(fmt::format("{}, {} bytes", method, budget)));
  const Fit made =
      fit(material_.source, {.form = BaselineMethod{.method = method, .bytes = budget}, .score = false});
  const auto kept =
      std::make_shared<const SeparableBrdf>(std::get<SeparableBrdf>(std::get<BaselineBrdf>(made.brdf)));
  Row row = row_of(method, kept->bytes(), *kept);
  row.budget = budget;
  row.fetches = kept->u().terms + kept->v().terms;  // a texel holds the channels of a term
  row.seconds = made.report.seconds;
  entries_.push_back({row, one_by_one(set_, kept), {}, {}});
}

void Contest::time_evaluations() {
  struct Place {
    std::size_t entry;
    double Row::*value;
  };
  std::vector<std::function<void()>> tasks;
  std::vector<Place> places;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].one_by_one) {
      tasks.push_back(entries_[i].one_by_one);
      places.push_back({i, &Row::one_by_one});
    }
    if (entries_[i].batched) {
      tasks.push_back(entries_[i].batched);
      places.push_back({i, &Row::batched});
    }
  }
  const std::vector<Times> times = time_in_turns(tasks, extent_.turns);
  for (std::size_t k = 0; k < times.size(); ++k)
    entries_[places[k].entry].row.*places[k].value =
        1e9 * times[k].least / static_cast<double>(set_.pairs().size());
}

void Contest::time_all_frames() {
  std::vector<FrameMaterial> materials;
  std::vector<Row*> rows;
  for (Entry& entry : entries_) {
    if (!entry.frame) continue;
    if (const double found = picture_psnr(*entry.frame); !(found >= kMinPicturePsnr)) {
      tell(fmt::format("cost: {}: no frame, its picture has {:.1f} dB", entry.frame->name, found));
      continue;
    }
    materials.push_back(*entry.frame);
    rows.push_back(&entry.row);
  }
  const std::vector<Times> times = time_frames(materials, extent_.lights, extent_.frames);
  double of_ggx = kNone;
  for (std::size_t k = 0; k < times.size(); ++k) {
    rows[k]->frame = times[k].least;
    if (rows[k]->method == "GGX") of_ggx = times[k].least;
  }
  for (Row* row : rows) row->of_ggx = row->frame / of_ggx;
}

std::vector<Row> Contest::rows(bool with_frames) {
  tell("cost: " + said("times"));
  time_evaluations();
  if (with_frames) time_all_frames();
  std::vector<Row> rows;
  for (const Entry& entry : entries_) {
    Row& row = rows.emplace_back(entry.row);
    if (!entry.same_as) continue;
    const Row& timed = entries_[*entry.same_as].row;
    row.one_by_one = timed.one_by_one;
    row.batched = timed.batched;
    row.frame = timed.frame;
    row.of_ggx = timed.of_ggx;
  }
  return rows;
}

// Returns the published network of a material of that name, if there is one.
std::optional<NeuralBrdf> published_network(const ReportOptions& options, const std::string& name) {
  if (!options.data) return {};
  const fs::path file = *options.data / "nbrdf/rgl.csv";
  if (!fs::exists(file)) return {};
  const std::vector<std::string> known = row_names(file);
  if (std::ranges::find(known, name) == known.end()) return {};
  return std::get<NeuralBrdf>(open_source(fmt::format("nbrdf:{}#{}", file.string(), name), {}).brdf);
}

std::vector<Row> rows_of(const ReportOptions& options, const Material& material, const Extent& extent,
                         const PairSet& set, bool with_frames) {
  Contest contest(material, set, extent);
  for (const std::size_t budget : extent.budgets) contest.add_fits(budget, extent.fetches);
  contest.add_ggx();
  if (const auto network = published_network(options, material.name)) contest.add_network(*network);
  contest.add_measurement();
  contest.add_merl();
  for (const char* method : {"svd", "nmf"})
    for (const std::size_t budget : extent.budgets) contest.add_separable(method, budget);
  return contest.rows(with_frames);
}

// Returns the mean of each figure over the materials that have it.
std::vector<Row> means_of(const std::vector<std::vector<Row>>& materials) {
  std::vector<Row> means;
  for (const auto& rows : materials)
    for (const Row& row : rows) {
      const auto same = [&](const Row& r) {
        return r.method == row.method && r.budget == row.budget && r.asked == row.asked;
      };
      if (std::ranges::any_of(means, same)) continue;
      Row mean{.method = row.method, .budget = row.budget, .asked = row.asked};
      for (const Column& column : kColumns) {
        double sum = 0;
        int count = 0;
        for (const auto& others : materials)
          for (const Row& other : others)
            if (same(other) && !std::isnan(other.*column.value)) {
              sum += other.*column.value;
              ++count;
            }
        if (count > 0) mean.*column.value = sum / count;
      }
      means.push_back(std::move(mean));
    }
  return means;
}

struct Look {
  const char *method, *color;
};
constexpr Look kLooks[] = {{"GGX", "#2a9d6f"},
                           {"network", "#7a4fb0"},
                           {"MERL table, nearest", "#17a2b8"},
                           {"MERL table, filtered", "#8c5a2b"},
                           {"svd", "#d1495b"},
                           {"nmf", "#e08e0b"}};
constexpr std::array kBlues{"#74aede", "#1b6ca8", "#0a2f52"};  // colours of our budgets
constexpr double kPointWidth = 8;
constexpr const char* kReferenceColor = "#8a8f98";

// Returns a line for each budget.
std::vector<PlotSeries> series_of_fits(const std::vector<Row>& means, double Row::*x) {
  std::vector<PlotSeries> series;
  std::map<std::size_t, std::size_t> place;  // index of each budget's series
  for (const Row& row : means) {
    if (row.method != "ours") continue;
    const auto [at, added] = place.try_emplace(row.budget, series.size());
    if (added)
      series.push_back({.label = fmt::format("ours, {} bytes", row.budget),
                        .style = PlotStyle::line_and_points,
                        .color = kBlues[std::min(series.size(), kBlues.size() - 1)],
                        .point_width = kPointWidth});
    series[at->second].x.push_back(row.*x);
    series[at->second].y.push_back(row.relative);
  }
  return series;
}

struct Interval {
  double least = std::numeric_limits<double>::max(), most = 0;
};
// Returns the interval of a figure's positive values.
Interval interval_of(const std::vector<Row>& means, double Row::*figure) {
  Interval interval;
  for (const Row& row : means)
    if (row.*figure > 0)
      interval = {std::min(interval.least, row.*figure), std::max(interval.most, row.*figure)};
  return interval;
}

// Returns a point for each budget. Where x is 0, which a logarithmic axis does not have, it is a line across the plot.
PlotSeries series_of_peer(const std::vector<Row>& means, const Look& look, double Row::*x) {
  PlotSeries series{.label = look.method,
                    .style = PlotStyle::line_and_points,
                    .color = look.color,
                    .point_width = kPointWidth};
  for (const Row& row : means) {
    if (row.method != look.method || std::isnan(row.*x) || std::isnan(row.relative)) continue;
    if (row.*x > 0) {
      series.x.push_back(row.*x);
      series.y.push_back(row.relative);
    } else {
      const Interval across = interval_of(means, x);
      series.style = PlotStyle::dashed;
      series.x = {across.least, across.most};
      series.y = {row.relative, row.relative};
    }
  }
  if (series.x.size() == 1) series.style = PlotStyle::points;
  return series;
}

// Plots the relative error over one figure. Methods without that figure are left out. The reference, which has no
// error, is a vertical line.
Plot plot_of(const std::vector<Row>& means, const std::string& x_label, double Row::*x) {
  Plot plot{.title = "Relative error against " + x_label,
            .x_label = x_label,
            .y_label = "relative",
            .log_x = true,
            .log_y = true,
            .series = series_of_fits(means, x),
            .height = 520};
  for (const Look& look : kLooks)
    if (PlotSeries series = series_of_peer(means, look, x); !series.x.empty())
      plot.series.push_back(std::move(series));
  const Interval upwards = interval_of(means, &Row::relative);
  for (const Row& row : means)
    if (std::isnan(row.relative) && row.*x > 0)
      plot.series.push_back({.label = row.method,
                             .x = {row.*x, row.*x},
                             .y = {upwards.least, upwards.most},
                             .style = PlotStyle::dashed,
                             .color = kReferenceColor});
  return plot;
}

// Returns null where the machine has no OpenGL.
std::unique_ptr<GlContext> open_gl() {
  try {
    return std::make_unique<GlContext>(GlDevice::gpu_first);
  } catch (const Error& error) {
    tell(fmt::format("cost: no frames: {}", error.what()));
    return nullptr;
  }
}

}  // namespace

void report_cost(const ReportOptions& options) {
  Page page(options, "cost");
  const Extent extent = extent_of(options.quick);
  const std::unique_ptr<GlContext> context = open_gl();
  const PairSet set(extent.pairs);
  std::vector<std::string> names;
  std::vector<std::vector<Row>> materials;
  std::vector<Source> sources = cost_sources(options);
  for (Source& source : sources) {
    names.push_back(source.name);
    tell(fmt::format("cost: material {} of {}: {}", names.size(), sources.size(), source.name));
    const Material material(names.back(), std::move(source), extent.figures);
    materials.push_back(rows_of(options, material, extent, set, context != nullptr));
  }

  Table all(head_of_columns({"material", "method", "budget", "within fetches"}));
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const Row& row : materials[i]) all.add(cells_of({names[i]}, row));
  page.write_rows("rows", all);
  const std::vector<Row> means = means_of(materials);
  Table table(head_of_columns({"method", "budget", "within fetches"}));
  for (const Row& row : means) table.add(cells_of({}, row));
  page["materials"] = fmt::format("{} material{}{}", names.size(), names.size() == 1 ? "" : "s",
                                  options.quick ? ", a quick trial" : "");
  page["pairs"] = std::to_string(extent.pairs);
  page["fetches"] = fmt::format("{}", fmt::join(extent.fetches, ", "));
  page["turns"] = std::to_string(extent.turns);
  page["rows"] = table.markdown();
  page["frames"] = fmt::format("the least of {} of {} x {} pixels in turn under {} light{}", extent.frames,
                               kFrameSize, kFrameSize, extent.lights, extent.lights == 1 ? "" : "s");
  page["renderer"] = context ? "drawn by " + drawn_by(*context) : "left out: no OpenGL was to be had";
  page.write_plot("cost-batched", plot_of(means, "nanoseconds an evaluation, batched", &Row::batched));
  page.write_plot("cost-one-by-one",
                  plot_of(means, "nanoseconds an evaluation, one by one", &Row::one_by_one));
  page.write_plot("cost-fetches", plot_of(means, "fetches an evaluation", &Row::fetches));
  if (context) {
    page.write_plot("cost-frame", plot_of(means, "milliseconds a frame", &Row::frame));
    page["frame_plot"] = "![Error over milliseconds a frame](../figures/cost-frame.svg)";
  }
  page.write();
}

}  // namespace burnish::reports
