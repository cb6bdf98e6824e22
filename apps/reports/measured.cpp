// SPDX-License-Identifier: Apache-2.0
// Compares models with measured values that they have not seen: nodes, incidences, another scan. Measures the light
// that noise adds.
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include <fmt/format.h>

#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/testing/noisy_table.h>

#include "report.h"
#include "scattered.h"

namespace burnish::reports {

namespace {

constexpr std::size_t kBytes = 16'384, kFewBytes = 2700, kQuickBytes = 1350;
constexpr int kNodeFetches = 3;  // in fits of nodes, where the page says so

// Returns the budget. A quick trial has few bytes, which are fitted in a tenth of the time.
std::size_t most_bytes(const Page& page) {
  return page.options().quick ? kQuickBytes : kBytes;
}

std::vector<fs::path> rgl_files(const Page& page) {
  std::vector<fs::path> files = files_in(*page.options().data / "rgl");
  if (page.options().quick) files.resize(1);
  return files;
}

Fit fit_nodes_without(const Source& source, const NodePart& held_out, std::optional<FitForm> form = {}) {
  return fit(source,
             {.form = std::move(form), .target = FitTarget::nodes, .hold_out = held_out, .score = false});
}

// Means over all added figures.
struct MeanNodes {
  double relative = 0, log_cos = 0;
  int count = 0;

  void add(const NodeFigures& figures) {
    relative += figures.relative;
    log_cos += figures.log_cos;
    ++count;
  }
  NodeFigures mean() const { return {.log_cos = log_cos / count, .relative = relative / count}; }
};

std::string text_of(const NodeFigures& figures) {
  return fmt::format("{:.3f} / {:.4f}", figures.relative, figures.log_cos);
}

std::vector<std::string> figures_of(const NodeFigures& figures) {
  return {fmt::format("{:.3f}", figures.relative), fmt::format("{:.4f}", figures.log_cos)};
}

// ---- One half of the nodes by the other

struct Predictor {
  const char* name;
  MeanNodes all = {};  // mean over the materials
};

// Returns the mean figures of each predictor over both halves of a material's nodes. `rows` gets the figures of each
// half.
std::vector<NodeFigures> score_halves(const Source& source, const std::string& name, std::uint64_t bytes,
                                      const fs::path& data, std::span<const Predictor> predictors,
                                      Table& rows) {
  const SymmetrizedBrdf function(source.ref());
  const Source network = open_source(fmt::format("nbrdf:{}#{}", (data / "nbrdf/rgl.csv").string(), name), {}),
               np = open_source(fmt::format("np:{}#{}", (data / "np").string(), name), {});
  const SymmetrizedBrdf symmetrized_network(network.ref()), symmetrized_np(np.ref());
  const Fit of_function =
      fit(source, {.form = Budget{.bytes = bytes}, .target = FitTarget::function, .score = false});
  const MeasuredNodes nodes = measured_nodes(source);

  std::vector<MeanNodes> means(predictors.size());
  for (const std::uint32_t half : {0u, 1u}) {
    const NodePart part{NodePart::Kind::half, half};
    const MeasuredNodes unseen = nodes_of(nodes, part);
    const Fit of_nodes = fit_nodes_without(source, part, Budget{.bytes = bytes});
    const std::array<BrdfRef, 5> models{function, symmetrized_network, symmetrized_np, of_function.ref(),
                                        of_nodes.ref()};
    for (std::size_t k = 0; k < models.size(); ++k) {
      const NodeFigures figures = node_figures(unseen, models[k]);
      means[k].add(figures);
      rows.add(joined({name, std::to_string(half), predictors[k].name}, figures_of(figures)));
    }
  }
  std::vector<NodeFigures> figures;
  for (const MeanNodes& mean : means) figures.push_back(mean.mean());
  return figures;
}

// Reports, for every material and half, how well each predictor knows the nodes of that half. The file's own function
// knows them, and the published models have learnt them. Our second fit sees the other half alone.
void report_halves(Page& page, const fs::path& data) {
  std::vector<Predictor> predictors{{"the file's function, which knows them"},
                                    {"network"},
                                    {"np"},
                                    {"ours, of the function"},
                                    {"ours, of the other half"}};
  Table rows({"material", "half", "predicted by", "relative", "log_cos"});
  Table table({"material", "the file's function", "network", "np", "ours, of the function",
               "ours, of the other half", "ln of the last over the first"});
  double log_relative = 0, log_log_cos = 0;
  const std::vector<fs::path> files = rgl_files(page);
  for (const fs::path& file : files) {
    const std::string name = file.stem().string();
    tell("measured: " + name + ", halves");
    const std::vector<NodeFigures> means =
        score_halves(open_source(file.string(), {}), name, most_bytes(page), data, predictors, rows);
    std::vector<std::string> texts{name};
    for (std::size_t k = 0; k < means.size(); ++k) {
      predictors[k].all.add(means[k]);
      texts.push_back(text_of(means[k]));
    }
    const double relative = std::log(means.back().relative / means.front().relative),
                 log_cos = std::log(means.back().log_cos / means.front().log_cos);
    log_relative += relative;
    log_log_cos += log_cos;
    texts.push_back(fmt::format("{:+.3f} / {:+.3f}", relative, log_cos));
    table.add(texts);
  }
  std::vector<std::string> texts{"**mean**"};
  for (const Predictor& predictor : predictors) texts.push_back(text_of(predictor.all.mean()));
  const auto count = static_cast<double>(files.size());
  texts.push_back(fmt::format("**{:+.3f} / {:+.3f}**", log_relative / count, log_log_cos / count));
  table.add(texts);
  page["halves"] = table.markdown();
  page.write_rows("halves", rows);
}

// ---- An incidence by the others

// Returns the table that its owner would have without the measurements at one theta_i.
RglTable without_incidence(RglData data, std::size_t left_out) {
  const std::size_t incidences = data.theta_i.size();
  for (RglGrid* grid : {&data.vndf, &data.luminance, &data.spectra}) {
    const std::size_t slice = grid->values.size() / (data.phi_i.size() * incidences);
    std::vector<float> kept;
    for (std::size_t k = 0; k < data.phi_i.size() * incidences; ++k)
      if (k % incidences != left_out)
        kept.insert(kept.end(), grid->values.begin() + static_cast<std::ptrdiff_t>(k * slice),
                    grid->values.begin() + static_cast<std::ptrdiff_t>((k + 1) * slice));
    grid->values = std::move(kept);
  }
  data.theta_i.erase(data.theta_i.begin() + static_cast<std::ptrdiff_t>(left_out));
  data.valid.clear();
  return RglTable(std::move(data));
}

void report_incidences(Page& page) {
  const std::array<const char*, 3> methods{"the file's function without it", "the same made reciprocal",
                                           "ours"};
  Table rows({"material", "theta_i", "predicted by", "relative", "log_cos"});
  Table table({"material", methods[0], methods[1], methods[2]});
  std::array<MeanNodes, 3> all;
  const bool quick = page.options().quick;
  for (const fs::path& file : rgl_files(page)) {
    const std::string name = file.stem().string();
    tell("measured: " + name + ", incidences");
    const Source source = open_source(file.string(), {});
    const RglData& data = std::get<RglTable>(source.brdf).data();
    const MeasuredNodes nodes = measured_nodes(source);
    std::array<MeanNodes, 3> means;
    // The outermost incidences have no neighbours on one side.
    for (std::size_t k = 1; k + 1 < data.theta_i.size() && (k == 1 || !quick); ++k) {
      if (std::cos(double{data.theta_i[k]}) <= NodeScoring{}.least_cosine) continue;  // no node is scored
      const NodePart part{NodePart::Kind::incidence, static_cast<std::uint32_t>(k)};
      const MeasuredNodes unseen = nodes_of(nodes, part);
      const RglTable left(without_incidence(data, k));
      const SymmetrizedBrdf symmetrized(left);
      const Fit ours = quick ? fit_nodes_without(source, part, Budget{.bytes = kQuickBytes})
                             : fit_nodes_without(source, part);
      const std::array<BrdfRef, 3> models{left, symmetrized, ours.ref()};
      for (std::size_t m = 0; m < models.size(); ++m) {
        const NodeFigures figures = node_figures(unseen, models[m]);
        means[m].add(figures);
        rows.add(joined({name, fmt::format("{:.1f}", degrees(double{data.theta_i[k]})), methods[m]},
                        figures_of(figures)));
      }
    }
    std::vector<std::string> texts{name};
    for (std::size_t m = 0; m < means.size(); ++m) {
      all[m].add(means[m].mean());
      texts.push_back(text_of(means[m].mean()));
    }
    table.add(texts);
  }
  std::vector<std::string> texts{"**mean**"};
  for (const MeanNodes& mean : all) texts.push_back(text_of(mean.mean()));
  table.add(texts);
  page["incidences"] = table.markdown();
  page.write_rows("incidences", rows);
}

// ---- Another scan

std::vector<std::string> figures_of(const ErrorFigures& e) {
  return {fmt::format("{:.2f}", e.psnr),     fmt::format("{:.4f}", e.ssim),
          fmt::format("{:.4f}", e.relative), fmt::format("{:.4f}", e.log_cos),
          fmt::format("{:.3f}", e.rms_log),  fmt::format("{:.2f}", e.rms)};
}

// Two scans of one sample, a fine one and a coarse one.
struct Scans {
  std::array<fs::path, 2> files;
  std::array<Source, 2> sources{open_source(files[0].string(), {}), open_source(files[1].string(), {})};
  std::array<SymmetrizedBrdf, 2> functions{SymmetrizedBrdf(sources[0].ref()),
                                           SymmetrizedBrdf(sources[1].ref())};
  std::array<const char*, 2> names{"fine", "coarse"};
};

// Scores each scan and its fits as predictions of the other scan's function.
Table repeat_table(const Scans& scans, bool quick) {
  const FigureOptions options{.count = quick ? std::size_t{10'000} : std::size_t{1'000'000}};
  Table table({"predicted", "by", "bytes", "psnr", "ssim", "relative", "log_cos", "rms_log", "rms"});
  for (std::size_t to = 0; to < scans.sources.size(); ++to) {
    const std::size_t from = 1 - to;
    tell(fmt::format("measured: the {} scan by the {} one", scans.names[to], scans.names[from]));
    const Scorer scorer(scans.functions[to], options);
    const auto add = [&](const std::string& by, const std::string& bytes, BrdfRef model) {
      table.add(joined({scans.names[to], by, bytes}, figures_of(scorer.score(model))));
    };
    add(fmt::format("the {} scan itself", scans.names[from]),
        std::to_string(fs::file_size(scans.files[from])), scans.functions[from]);
    const auto add_fit = [&](const std::string& how, const Budget& budget) {
      const Fit made =
          fit(scans.sources[from], {.form = budget, .target = FitTarget::function, .score = false});
      add(how, std::to_string(made.bytes()), made.ref());
    };
    add_fit("`--budget 2700`", {.bytes = kFewBytes});
    if (quick) break;
    add_fit("`--budget 16K`", {.bytes = kBytes});
    add_fit("`--budget 16K --fetches 6 --smooth auto`",
            {.bytes = kBytes, .fetches = 6, .scattered = {.cross_validate = true}});
    add_fit("`--budget 64K`", {.bytes = 65'536});
  }
  return table;
}

// Scores each scan and its fits at the nodes of the other scan.
Table repeat_nodes_table(const Scans& scans, std::uint64_t bytes, bool quick) {
  Table table({"nodes of", "nodes", "by its own function", "by the other's", "ours, of the other's function",
               "ours, of the other's nodes"});
  for (std::size_t to = 0; to < (quick ? 1 : scans.sources.size()); ++to) {
    const Source& other = scans.sources[1 - to];
    const MeasuredNodes nodes = measured_nodes(scans.sources[to]);
    const Budget budget{.bytes = bytes, .fetches = kNodeFetches};
    const Fit of_function = fit(other, {.form = budget, .target = FitTarget::function, .score = false}),
              of_nodes = fit(other, {.form = budget, .target = FitTarget::nodes, .score = false});
    std::vector<std::string> texts{scans.names[to], ""};
    for (const BrdfRef model : {BrdfRef(scans.functions[to]), BrdfRef(scans.functions[1 - to]),
                                of_function.ref(), of_nodes.ref()}) {
      const NodeFigures figures = node_figures(nodes, model);
      texts[1] = std::to_string(figures.count);
      texts.push_back(text_of(figures));
    }
    table.add(texts);
  }
  return table;
}

void report_repeat(Page& page, const fs::path& data) {
  const std::string name = "irid_flake_paint1";
  const fs::path coarse = data / "rgl" / (name + "_rgb.bsdf"),
                 fine = data / "repeat" / (name + "_fine_rgb.bsdf");
  if (!fs::exists(coarse) || !fs::exists(fine)) return;
  const Scans scans{.files = {fine, coarse}};
  page["repeat"] = repeat_table(scans, page.options().quick).markdown();
  page["repeat_nodes"] = repeat_nodes_table(scans, most_bytes(page), page.options().quick).markdown();
}

// ---- Formats whose owners interpolate what was measured

// Scores predictions of one file of each format at the nodes of both halves. The fit of the function knows these nodes;
// the fit of nodes sees the other half alone.
void report_formats(Page& page, const fs::path& data) {
  const auto first_in = [&](const char* folder) {
    const std::vector<fs::path> files = files_in(data / folder);
    return files.empty() ? std::string() : files.front().string();
  };
  std::vector<std::string> sources{first_in("mbsdf"), first_in("zemax"), first_in("tensortree"),
                                   first_in("speos")};
  if (page.options().quick) sources.resize(1);
  Table table(
      {"file", "format", "nodes", "the file's function", "ours, of the function", "ours, of the other half"});
  for (const std::string& file : sources) {
    if (file.empty()) continue;
    tell("measured: " + fs::path(file).filename().string());
    const Source source = open_source(file, {});
    const SymmetrizedBrdf function(source.ref());
    const Budget budget{.bytes = most_bytes(page), .fetches = kNodeFetches};
    const Fit of_function = fit(source, {.form = budget, .target = FitTarget::function, .score = false});
    const MeasuredNodes nodes = measured_nodes(source);
    std::array<MeanNodes, 3> means;
    for (const std::uint32_t half : {0u, 1u}) {
      const NodePart part{NodePart::Kind::half, half};
      const MeasuredNodes unseen = nodes_of(nodes, part);
      const Fit of_nodes = fit_nodes_without(source, part, budget);
      const std::array<BrdfRef, 3> models{function, of_function.ref(), of_nodes.ref()};
      for (std::size_t m = 0; m < models.size(); ++m) means[m].add(node_figures(unseen, models[m]));
    }
    std::vector<std::string> texts{fs::path(file).filename().string(), source.findings.format,
                                   std::to_string(nodes.size())};
    for (const MeanNodes& mean : means) texts.push_back(text_of(mean.mean()));
    table.add(texts);
  }
  page["formats"] = table.markdown();
}

// ---- Light that noise adds

void report_noise(Page& page, const std::optional<fs::path>& data) {
  std::vector<std::pair<std::string, Source>> sources;
  sources.emplace_back("virtual GGX", Source{.name = {}, .brdf = fixtures::noisy_table(), .findings = {}});
  if (data && !page.options().quick)
    sources.emplace_back("carpaint_blue", open_source((*data / "mbsdf/carpaint_blue.mbsdf").string(), {}));

  Table table({"source", "theta_i", "albedo", "with negatives cut", "2,700 bytes", "16 KB, 2 fetches"});
  for (const auto& [name, source] : sources) {
    tell("measured: albedo of " + name);
    const SymmetrizedBrdf function(source.ref());
    const Fit few = fit(source, {.form = Budget{.bytes = kFewBytes}, .score = false}),
              many = fit(source, {.form = Budget{.bytes = most_bytes(page), .fetches = 2}, .score = false});
    for (const double theta_i : {0, 15, 30, 45, 60}) {
      const Vec3 wi = spherical_direction(radians(theta_i), 0);
      const DirectionalAlbedo own = directional_albedo(function, wi, 2e-3);
      // The channel with the largest relative deviation is reported; channels that reflect nothing are left out.
      const auto off = [&](const Fit& made) {
        const std::vector<double> found = directional_albedo(made.ref(), wi, 2e-3).albedo;
        double most = 0;
        for (std::size_t c = 0; c < found.size(); ++c) {
          if (own.albedo[c] <= 0) continue;
          if (const double by = found[c] / own.albedo[c] - 1; std::abs(by) > std::abs(most)) most = by;
        }
        return fmt::format("{:+.2f} %", 100 * most);
      };
      const auto mean = [](const std::vector<double>& albedo) {
        double sum = 0;
        for (const double a : albedo) sum += a / static_cast<double>(albedo.size());
        return fmt::format("{:.4f}", sum);
      };
      table.add(
          {name, fmt::format("{:.0f}", theta_i), mean(own.albedo), mean(own.clamped), off(few), off(many)});
    }
  }
  page["noise"] = table.markdown();
}

// ---- As it is

void report_order(Page& page, const fs::path& data) {
  const std::string name = "vch_silk_blue_rgb";
  const fs::path file = data / "rgl" / (name + ".bsdf");
  if (!fs::exists(file)) return;
  tell("measured: " + name + ", not made reciprocal");
  const Source source = open_source(file.string(), {});
  const Scorer scorer(source.ref());
  Table table({"fit", "bytes", "psnr", "ssim", "relative", "log_cos", "rms_log", "rms"});
  std::vector<std::size_t> budgets{kFewBytes, kBytes};
  if (page.options().quick) budgets = {kQuickBytes};
  for (const std::size_t bytes : budgets)
    for (const bool symmetrize : {true, false}) {
      const Fit made = fit(source, {.form = Budget{.bytes = bytes},
                                    .target = FitTarget::function,
                                    .symmetrize = symmetrize,
                                    .score = false});
      table.add(joined({fmt::format("`--budget {}{}`", bytes == kBytes ? "16K" : std::to_string(bytes),
                                    symmetrize ? "" : " --no-symmetrize"),
                        std::to_string(made.bytes())},
                       figures_of(scorer.score(made.ref()))));
    }
  page["order"] = table.markdown();
}

// ---- Scattered samples

// Returns the relative error over all parts, each predicted by a fit of the other samples.
double foretold(const Samples& samples, const FitForm& form, std::span<const Fold> parts) {
  FoldErrors errors;
  std::array<double, 3> f;
  for (const auto& [training, test] : parts) {
    const Fit part = fit(source_of(select(samples, training)), {.form = form, .score = false});
    for (const std::size_t i : test) {
      part.ref().eval(samples.pairs[i].wi, samples.pairs[i].wo, f);
      errors.add(samples.at(i), f);
    }
  }
  return errors.relative(0);
}

void report_scattered(Page& page, const fs::path& data) {
  const std::array<std::pair<const char*, FitForm>, 3> forms{
      {{"`--budget 1350`", Budget{.bytes = 1350}},
       {"`--budget 2700`", Budget{.bytes = kFewBytes}},
       {"a coarse p", OneLobe{.model = kScatteredModel,
                              .tables = {"p=8", "q=96,rational:0.2", "r=12", "m=24,power:0.5"}}}}};
  Table table({"paint", "fit", "bytes", "seconds", "fifths of the rows", "whole theta_i"});
  for (const char* paint : kPaints) {
    const Samples samples = read_paint(data, paint);
    std::vector<Fold> fifths;
    for (std::size_t fold = 0; fold < kFolds; ++fold) fifths.push_back(split_fold(samples.size(), fold));
    // The outermost incidences have no neighbours on one side.
    const MeasuredNodes nodes = measured_nodes(samples);
    std::vector<Fold> incidences(nodes.theta_i.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
      for (std::size_t k = 0; k < incidences.size(); ++k)
        (nodes.incidence[i] == k ? incidences[k].test : incidences[k].training).push_back(i);
    const std::span<const Fold> inner(incidences.begin() + 1, incidences.end() - 1);
    for (const auto& [name, form] : forms) {
      tell(fmt::format("measured: {}, {}", paint, name));
      const Fit whole = fit(source_of(samples), {.form = form, .score = false});
      table.add({paint, name, std::to_string(whole.bytes()), fmt::format("{:.1f}", whole.report.seconds),
                 fmt::format("{:.3f}", foretold(samples, form, fifths)),
                 fmt::format("{:.3f}", foretold(samples, form, inner))});
    }
  }
  page["scattered"] = table.markdown();
}

}  // namespace

void report_measured(const ReportOptions& options) {
  Page page(options, "measured");
  if (options.data && options.wants("halves")) report_halves(page, *options.data);
  if (options.data && options.wants("incidences")) report_incidences(page);
  if (options.data && options.wants("repeat")) report_repeat(page, *options.data);
  if (options.data && options.wants("formats")) report_formats(page, *options.data);
  if (options.wants("noise")) report_noise(page, options.data);
  if (options.data && options.wants("order")) report_order(page, *options.data);
  if (options.data && !options.quick && options.wants("scattered")) report_scattered(page, *options.data);
  page.write();
}

}  // namespace burnish::reports
