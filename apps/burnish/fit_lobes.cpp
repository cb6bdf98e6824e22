#include "fit_lobes.h"

#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/table_format.h>
#include <burnish/fitting/budget.h>
#include <burnish/fitting/rounding.h>
#include <burnish/fitting/search.h>
#include <burnish/reflectance/brdf.h>

#include "progress.h"

namespace burnish::cli {

namespace {

// An anisotropic source has one dimension more to fill.
constexpr std::size_t kIsotropicDirections = 60'000, kAnisotropicDirections = 200'000;

ErrorTerms shares_of(const std::string& loss) {
  if (loss == "relative") return {0, 0, 1, 0};
  if (loss == "log_cos") return {0, 0, 0.1, 1};
  return PictureLoss{}.shares;
}

// Three channels share an exponent unless told otherwise: a third fewer bytes for hardly any error.
TableFormat format_of(const LobesArguments& arguments, int channels) {
  if (arguments.format.empty()) return channels == 3 ? TableFormat::rgb9e5 : TableFormat::half;
  const TableFormat format = parse_table_format(arguments.format);
  if (!holds_channels(format, channels))
    throw Error(
        fmt::format("--format {}: expected a source of 3 channels, found {}", arguments.format, channels));
  return format;
}

/// What is fitted, drawn from the source.
TrainingSet training_set(const Source& source, const LobesArguments& arguments, bool spread_phi_h) {
  if (const Samples* samples = source.samples()) return training_set_of(*samples, !arguments.no_symmetrize);
  std::optional<SymmetrizedBrdf> symmetrized;
  if (!arguments.no_symmetrize) symmetrized.emplace(source.ref());
  const BrdfRef brdf = symmetrized ? BrdfRef(*symmetrized) : source.ref();
  return draw_training_set(brdf,
                           {.directions = brdf.isotropic() ? kIsotropicDirections : kAnisotropicDirections,
                            .seed = arguments.seed,
                            .spread_phi_h = spread_phi_h});
}

RefineOptions refine_options(const LobesArguments& arguments, int channels) {
  RefineOptions options{.shares = shares_of(arguments.loss), .format = format_of(arguments, channels)};
  if (arguments.smooth >= 0) options.smooth = arguments.smooth;
  options.progress = progress_bar("fitting");
  return options;
}

FactoredBrdf finish(const LobesFit& fit, const TrainingSet& set, const LobesArguments& arguments,
                    const RefineOptions& refine, nlohmann::ordered_json& notes) {
  notes["samples"] = set.size();
  notes["lobes"] = fit.summary.lobes;
  notes["loss"] = arguments.loss;
  notes["iterations"] = fit.summary.iterations;
  notes["stop_reason"] = fit.summary.stop_reason;
  notes["objective"] = fit.summary.objective_after;
  return to_rounded_brdf(fit.model, set, refine);
}

}  // namespace

void add_lobes_arguments(CLI::App& verb, LobesArguments& arguments) {
  verb.add_option("--budget", arguments.budget,
                  "bytes: fits the best model of several lobes that this many hold; K and M count as 1024s")
      ->transform(CLI::AsSizeValue(false));
  verb.add_option("--lobes", arguments.lobes, "of --budget (default: as many as serve it best)")
      ->check(CLI::Range(1, 64))
      ->needs("--budget");
  verb.add_option(
          "--loss", arguments.loss,
          "what several lobes are refined for: pictures at every exposure beside both means, or one mean")
      ->check(CLI::IsMember({"image", "relative", "log_cos"}))
      ->capture_default_str();
  verb.add_flag("--search", arguments.search,
                "of --budget: search factors, projections, warps and sizes first (up to a minute)")
      ->needs("--budget");
}

FactoredBrdf fit_to_budget(const Source& source, const LobesArguments& arguments,
                           nlohmann::ordered_json& notes) {
  const BrdfRef brdf = source.ref();
  const std::size_t texel = burnish::texel_bytes(format_of(arguments, brdf.channels()), brdf.channels());
  const TrainingSet set = training_set(source, arguments, false);
  LobePlan plan = default_plan(arguments.budget, arguments.lobes, brdf.isotropic(), texel);
  const RefineOptions refine = refine_options(arguments, brdf.channels());
  if (arguments.search) {
    const SearchResult found = search_plan(set, plan,
                                           {.bytes = arguments.budget,
                                            .texel_bytes = texel,
                                            .refine = refine,
                                            .progress = progress_bar("searching")});
    plan = found.plan;
    nlohmann::ordered_json kept = nlohmann::ordered_json::array();
    for (const SearchTrial& trial : found.trials)
      if (trial.kept) kept.push_back({{"change", trial.change}, {"objective", trial.objective}});
    notes["search"] = {{"trials", found.trials.size()}, {"kept", std::move(kept)}};
  }
  notes["budget"] = arguments.budget;
  return finish(fit_plan(set, plan, arguments.budget, texel, refine), set, arguments, refine, notes);
}

FactoredBrdf fit_several_lobes(const Source& source, const ModelSpec& spec, const LobesArguments& arguments,
                               nlohmann::ordered_json& notes) {
  bool disk = false;
  for (const ModelSpec::TableSpec& table : spec.tables) disk |= table.layout.shape == TableShape::disk;
  const TrainingSet set = training_set(source, arguments, disk);
  const RefineOptions refine = refine_options(arguments, set.channels);
  return finish(fit_lobes(set, spec, refine), set, arguments, refine, notes);
}

ModelSpec one_lobe_spec(const Source& source, const LobesArguments& arguments) {
  const BrdfRef brdf = source.ref();
  const std::size_t texel = burnish::texel_bytes(format_of(arguments, brdf.channels()), brdf.channels());
  LobePlan plan = default_plan(arguments.budget, brdf.isotropic() ? 1 : 2, brdf.isotropic(), texel);
  plan.wide.clear();
  plan.wide_texels = 0;
  return plan_to_spec(plan, arguments.budget, brdf.channels(), texel);
}

}  // namespace burnish::cli
