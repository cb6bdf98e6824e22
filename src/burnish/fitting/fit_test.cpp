// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/io/open_source.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/albedo.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/testing/baselines.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/files.h>
#include <burnish/testing/noisy_table.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

AnalyticBrdf paint() {
  return parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5/0.3/0.1,kd=0.2");
}

AnalyticBrdf brushed() {
  return parse_analytic("ggx:alpha_x=0.2,alpha_y=0.5,f0=0.5,kd=0.2");
}

Source source_of(const std::string& name, AnyBrdf brdf) {
  Findings findings;
  findings.format = name + " format";
  return {name, std::move(brdf), std::move(findings)};
}

AngleTable angle_table() {
  AngleTable layout;
  layout.folded = true;
  layout.axes = {make_axis({0}, kTwoPi), make_axis(cell_centres(8, kHalfPi)),
                 make_axis(cell_centres(8, kHalfPi)), make_axis(cell_centres(12, kPi))};
  const AnalyticBrdf source = paint();
  return tabulate_angles(source, layout);
}

PatchTable patch_table() {
  const AnalyticBrdf source = paint();
  PatchTable table{klems_full_basis(), klems_full_basis(), {}};
  std::vector<double> f(3);
  for (std::size_t o = 0; o < table.outgoing.size(); ++o)
    for (std::size_t i = 0; i < table.incident.size(); ++i) {
      source.eval(table.incident.centre(i), table.outgoing.centre(o), f);
      table.values.push_back(static_cast<float>(f[0]));
    }
  return table;
}

// Returns a network with the value exp(0.3) - 1 everywhere: the biases of the outputs are the last weights.
NeuralBrdf neural() {
  std::vector<float> weights(NeuralBrdf::kWeights);
  std::fill(weights.end() - NeuralBrdf::kOutputs, weights.end(), 0.3f);
  return NeuralBrdf(weights);
}

FactoredBrdf factored() {
  const Table p{.name = "p", .layout = {.width = 3}, .channels = 1, .values = {1, 0.5f, 0.25f}};
  return {3, {p}, {{{0.1, 0.2, 0.3}, {{.table = 0, .projection = kProjectHalf}}}}};
}

// Returns one source of every kind.
std::vector<Source> every_source() {
  RglOptions rgl;
  rgl.theta_i_count = 4;
  rgl.ndf_theta = rgl.ndf_phi = rgl.resolution = 8;
  const AnalyticBrdf isotropic = paint();
  std::vector<Source> sources;
  sources.push_back(source_of("half/difference table", tabulate_half_diff(isotropic, 12, 8, 10, false)));
  sources.push_back(source_of("RGL table", make_rgl_table(isotropic, rgl)));
  sources.push_back(source_of("scattered", ScatteredBrdf(measure(isotropic, {.count = 400}))));
  sources.push_back(source_of("angle table", angle_table()));
  sources.push_back(source_of("patch table", patch_table()));
  sources.push_back(source_of("isotropic analytic", isotropic));
  sources.push_back(source_of("anisotropic analytic", brushed()));
  sources.push_back(source_of("neural", neural()));
  sources.push_back(source_of("separable", fixtures::random_separable(1, 0.2)));
  sources.push_back(source_of("microfacet", fixtures::random_dgf()));
  sources.push_back(source_of("factored", factored()));
  return sources;
}

// Options for one lobe of small tables, which is fitted quickly.
FitOptions small_lobe(const Source& source) {
  const bool isotropic = source.ref().isotropic();
  return {.form = OneLobe{.tables = isotropic ? std::vector<std::string>{"p=8", "q=12"}
                                              : std::vector<std::string>{"p=6x6", "q=8x8"}},
          .samples = 4000};
}

// Options for every form, for an isotropic source of three channels.
std::map<std::string, FitOptions> every_form() {
  std::map<std::string, FitOptions> forms{
      {"one lobe", {.form = OneLobe{.tables = {"p=8", "q=12"}}, .samples = 4000}},
      {"one lobe, robust",
       {.form = OneLobe{.model = "pqpr", .how = {.reweightings = 2, .floor = 1e-3}}, .samples = 4000}},
      {"one lobe that conserves energy", {.form = OneLobe{}, .samples = 4000, .conserve_energy = true}},
      {"budget", {.form = Budget{.bytes = 300}}},
      {"budget as smooth as given", {.form = Budget{.bytes = 500, .lobes = 2}, .smooth = 1e-6}},
      {"lobes",
       {.form = GivenLobes{.model = "p(wo) q(h) p(wi) + s(h)", .tables = {"p=8", "q=12", "s=6"}},
        .format = TableFormat::half}}};
  for (const std::string_view method : baseline_methods())
    forms[std::string(method)] = {.form = BaselineMethod{std::string(method), 400}, .samples = 2000};
  return forms;
}

double mean_error(BrdfRef reference, BrdfRef model) {
  return error_figures(SymmetrizedBrdf(reference), model, {.count = 2000, .image_size = 16}).relative;
}

TEST(Fit, MakesAModelOfEverySource) {
  for (const Source& source : every_source()) {
    const Fit made = fit(source, small_lobe(source));
    EXPECT_EQ(made.model().channels(), source.ref().channels()) << source.name;
    EXPECT_EQ(made.model().isotropic(), source.ref().isotropic()) << source.name;
    EXPECT_TRUE(made.model().reciprocal()) << source.name;
    EXPECT_EQ(made.report.source, source.name);
    EXPECT_EQ(made.report.source_format, source.findings.format);
    // Scattered samples have no function to compare with.
    EXPECT_EQ(made.report.held_out.has_value(), source.samples() == nullptr) << source.name;
    EXPECT_EQ(std::get<OneLobeReport>(made.report.how).relative.has_value(), source.samples() != nullptr);
  }
}

// Checks the properties of fits of every form; failures print the form's name.

void expect_near_source(const Source& source, const FitForm& form, const Fit& made, const std::string& name) {
  EXPECT_LT(mean_error(source.ref(), made.ref()), 1) << name;
  EXPECT_GT(made.report.seconds, 0) << name;
  ASSERT_TRUE(made.report.held_out) << name;
  EXPECT_NEAR(made.report.held_out->relative, mean_error(source.ref(), made.ref()), 0.1) << name;
  if (const auto* budget = std::get_if<Budget>(&form)) {
    EXPECT_LE(made.bytes(), budget->bytes) << name;
  }
  EXPECT_EQ(std::holds_alternative<BaselineBrdf>(made.brdf), std::holds_alternative<BaselineMethod>(form));
}

void expect_lower_error(const Fit& made, const std::string& name) {
  const auto summary = made.report.summary();
  const bool decomposition = name == "svd" || name == "nd" || name == "nmf";
  ASSERT_EQ(summary.has_value(), !decomposition) << name;
  if (!summary) return;
  EXPECT_LE(summary->error_after, summary->error_before) << name;
  EXPECT_GE(summary->iterations, 0) << name;
  EXPECT_FALSE(to_string(summary->stop_reason).empty());
}

void expect_report_in_file(const Fit& made, const std::string& name) {
  const auto notes = nlohmann::json::parse(to_json(made.report));
  const FileBytes file = memory_file(format_fit(made));
  if (std::holds_alternative<FactoredBrdf>(made.brdf)) {
    const Model model = parse_model(file);
    EXPECT_EQ(model.brdf, made.model()) << name;
    EXPECT_EQ(nlohmann::json::parse(model.notes), notes) << name;
    EXPECT_EQ(to_model(made).notes, to_json(made.report)) << name;
  } else {
    const Baseline baseline = parse_baseline(file);
    EXPECT_EQ(nlohmann::json::parse(baseline.notes), notes) << name;
    EXPECT_EQ(baseline_bytes(baseline.brdf), made.bytes());
    EXPECT_THROW(to_model(made), Error) << name;
    EXPECT_THROW(made.model(), Error) << name;
  }
  EXPECT_EQ(notes.at("source"), "paint");
  EXPECT_EQ(notes.at("relative"), made.report.held_out->relative) << name;
  const auto summary = nlohmann::json::parse(summary_json(made, "out", 1.5));
  EXPECT_EQ(summary.contains("shader"), std::holds_alternative<FactoredBrdf>(made.brdf)) << name;
  EXPECT_EQ(summary.at("bytes"), made.bytes()) << name;
  EXPECT_EQ(summary.at("seconds"), 1.5);
  EXPECT_FALSE(summary.contains("file_bytes")) << name;
  EXPECT_EQ(nlohmann::json::parse(summary_json(made, "out", 1.5, 321)).at("file_bytes"), 321) << name;
}

// Fits with two threads, and checks that the progress of each stage never falls.
Fit fit_with_stages(const Source& source, FitOptions options, const std::string& name) {
  std::map<std::string, double, std::less<>> stages;
  options.progress = [&](std::string_view stage, double fraction) {
    auto& last = stages.try_emplace(std::string(stage), 0).first->second;
    EXPECT_GE(fraction, last) << name << ": " << stage;
    EXPECT_LE(fraction, 1) << name << ": " << stage;
    last = fraction;
  };
  const ThreadLimit two(2);
  Fit made = fit(source, options);
  // One lobe of few unknowns is solved directly and reports no stages.
  EXPECT_TRUE(std::holds_alternative<OneLobe>(*options.form) || !stages.empty()) << name;
  return made;
}

// One fit of each form serves all checks, since fits take most of the time.
TEST(Fit, MakesEveryFormAndSaysWhatItMade) {
  const Source source = source_of("paint", paint());
  for (const auto& [name, options] : every_form()) {
    const Fit made = fit_with_stages(source, options, name);
    expect_near_source(source, *options.form, made, name);
    EXPECT_EQ(made.report.energy.has_value(), options.conserve_energy) << name;
    expect_lower_error(made, name);
    expect_report_in_file(made, name);
    if (BURNISH_SANITIZED) continue;
    const ThreadLimit one(1);
    EXPECT_EQ(format_fit(fit(source, options)), format_fit(made)) << name;
  }
}

TEST(Fit, EndsWhereTheCallerThrows) {
  const Source source = source_of("paint", paint());
  for (auto [name, options] : every_form()) {
    if (std::holds_alternative<OneLobe>(*options.form)) continue;
    options.progress = [](std::string_view, double) { throw Error("enough"); };
    EXPECT_EQ(error_of([&] { fit(source, options); }), "enough") << name;
  }
}

TEST(Fit, OfScatteredSamplesFollowsThemFartherThanOneLobe) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const AnalyticBrdf isotropic = paint();
  const Source source =
      source_of("scattered", ScatteredBrdf(measure(isotropic, {.count = 1500, .noise = 0.05})));
  const Fit nodes = fit(source, {}), lobe = fit(source, {.target = FitTarget::function});
  EXPECT_EQ(default_target(source, {}), FitTarget::nodes);
  ASSERT_TRUE(nodes.report.nodes);
  ASSERT_TRUE(nodes.report.nodes->covariance);
  EXPECT_NEAR(nodes.report.nodes->covariance->noise, 0.05, 0.015);
  EXPECT_FALSE(lobe.report.nodes);
  EXPECT_LE(fetch_count(nodes.model()), 2u);
  EXPECT_LT(mean_error(isotropic, nodes.ref()), 0.8 * mean_error(isotropic, lobe.ref()));
}

TEST(Fit, OfScatteredSamplesIsOneLobeWhereItsOptionsAreGiven) {
  const AnalyticBrdf isotropic = paint(), brushed_metal = brushed();
  const Source source = source_of("scattered", ScatteredBrdf(measure(isotropic, {.count = 200}))),
               anisotropic = source_of("brushed", ScatteredBrdf(measure(brushed_metal, {.count = 200})));
  EXPECT_EQ(default_target(source, {.form = Budget{}}), FitTarget::nodes);
  EXPECT_EQ(default_target(source, {.form = DefaultBudget{.scattered = {.floor = 1e-4}}}),
            FitTarget::function);
  EXPECT_EQ(default_target(source, {.form = Budget{.scattered = {.reweightings = 0}}}), FitTarget::function);
  EXPECT_EQ(default_target(source, {.form = Budget{.scattered = {.cross_validate = true}}}),
            FitTarget::function);
  EXPECT_EQ(default_target(source, {.form = GivenLobes{.model = "q(h) + s(h)"}}), FitTarget::function);
  EXPECT_EQ(default_target(source, {.symmetrize = false}), FitTarget::function);
  EXPECT_EQ(default_target(anisotropic, {}), FitTarget::function);  // too few
}

TEST(Fit, OfManyAnisotropicSamplesFollowsThemFartherThanOneLobe) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const AnalyticBrdf brushed_metal = brushed();
  const Source source =
      source_of("scattered", ScatteredBrdf(measure(brushed_metal, {.count = 1200, .noise = 0.05})));
  ASSERT_EQ(default_target(source, {}), FitTarget::nodes);
  const Budget small{.bytes = 4000, .fetches = 4};
  const Fit nodes = fit(source, {.form = small}),
            lobe = fit(source, {.form = small, .target = FitTarget::function});
  EXPECT_TRUE(nodes.report.nodes);
  EXPECT_LT(mean_error(brushed_metal, nodes.ref()), 0.8 * mean_error(brushed_metal, lobe.ref()));
}

TEST(Fit, GivesScatteredSamplesOneLobeOfTheBudget) {
  const AnalyticBrdf isotropic = paint();
  const Source source = source_of("scattered", ScatteredBrdf(measure(isotropic, {.count = 400})));
  const Fit made = fit(source, {.form = Budget{.bytes = 600, .scattered = {.floor = 1e-4}}, .smooth = 1e-6});
  EXPECT_EQ(made.model().lobes().size(), 1u);
  EXPECT_EQ(std::get<OneLobeReport>(made.report.how).floor, 1e-4);
}

TEST(Fit, DependsOnTheSeedAndOnWhatIsAskedFor) {
  const Source source = source_of("brushed", brushed());
  const FitOptions plain = small_lobe(source);
  const auto model_with = [&](auto change) {
    FitOptions options = plain;
    change(options);
    return fit(source, options).model();
  };
  const FactoredBrdf model = fit(source, plain).model();
  EXPECT_NE(model, model_with([](FitOptions& o) { o.seed = 2; }));
  EXPECT_NE(model, model_with([](FitOptions& o) { o.samples = 5000; }));
  EXPECT_NE(model, model_with([](FitOptions& o) { o.smooth = 1e-3; }));
  EXPECT_NE(model, model_with([](FitOptions& o) { o.format = TableFormat::single; }));
  EXPECT_EQ(model, model_with([](FitOptions& o) { o.score = false; }));
}

TEST(Fit, MakesByDefaultWhatTheDefaultBudgetSays) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = source_of("paint", paint());
  const Fit made = fit(source, {.seed = 3, .score = false});
  const Fit named = fit(source, {.form = DefaultBudget{}, .seed = 3, .score = false});
  EXPECT_EQ(made.model(), named.model());
  EXPECT_LE(made.bytes(), 16u << 10);
  EXPECT_LE(fetch_count(made.model()), 2u);
}

TEST(FitForm, IsOneLobeOrSeveral) {
  EXPECT_TRUE(std::holds_alternative<OneLobe>(form_of("p(wo) q(wi+wo+0.5n) p(wi)", {}, true, {}, {})));
  const FitForm form = form_of("p(wo) q(h) p(wi) + s(h)", {"s=6"}, true, {}, FitLoss::log_cos);
  ASSERT_TRUE(std::holds_alternative<GivenLobes>(form));
  EXPECT_EQ(std::get<GivenLobes>(form).loss, FitLoss::log_cos);
  EXPECT_THROW(form_of("p(wo) +", {}, true, {}, {}), Error);
  const FitForm none = form_of("", {}, false, {.floor = 1e-4}, FitLoss::relative);
  EXPECT_EQ(std::get<DefaultBudget>(none).loss, FitLoss::relative);
  EXPECT_EQ(std::get<DefaultBudget>(none).scattered.floor, 1e-4);
  EXPECT_EQ(std::get<OneLobe>(form_of("", {"q=8"}, true, {}, {})).model, OneLobe{}.model);
}

TEST(FitLoss, RoundTripsThroughItsName) {
  for (const FitLoss loss : {FitLoss::image, FitLoss::relative, FitLoss::log_cos})
    EXPECT_EQ(parse_fit_loss(to_string(loss)), loss);
  EXPECT_THROW(parse_fit_loss("picture"), Error);
}

TEST(Fit, ToNodesPredictsThoseHeldOut) {
  BURNISH_SKIP_WHERE_SANITIZED();
  constexpr double kNoise = 0.25;
  const fixtures::Glossy truth{.a = 8, .b = 8};
  const Source source =
      source_of("measured", ScatteredBrdf(measure(truth, {.count = 3000, .noise = kNoise})));
  const Fit made =
      fit(source,
          {.form = Budget{.bytes = 1000}, .target = FitTarget::nodes, .hold_out = parse_node_part("half=1")});
  ASSERT_TRUE(made.report.nodes);
  const NodesReport& report = *made.report.nodes;
  EXPECT_EQ(report.fitted, nodes_of(measured_nodes(source), parse_node_part("half=0")).size());
  // For noise alone the mean |error| is kNoise sqrt(2 / pi).
  EXPECT_LT(std::log1p(report.at_held_out.value().relative), 1.2 * kNoise * std::sqrt(2 / kPi));
  EXPECT_GT(report.at_held_out->relative, report.at_fitted.relative);
  // The fit is far closer to the truth than one of the samples is.
  EXPECT_LT(mean_error(truth, made.ref()), 0.5 * report.at_held_out->relative);
  EXPECT_LE(made.bytes(), 1000u);
  EXPECT_NE(to_json(made.report).find("node_test"), std::string::npos);
}

TEST(Fit, OfIsotropicRglFilesIsOfTheirNodesUnlessAskedOtherwise) {
  const AnalyticBrdf brushed_metal = brushed();
  RglOptions rgl;
  rgl.theta_i_count = 4;
  rgl.ndf_theta = rgl.ndf_phi = rgl.resolution = 8;
  const Source isotropic = source_of("isotropic", make_rgl_table(paint(), rgl)),
               anisotropic = source_of("anisotropic", make_rgl_table(brushed_metal, rgl)),
               merl = source_of("cells", tabulate_half_diff(paint(), 12, 8, 10, false));
  for (const FitTarget target : {FitTarget::function, FitTarget::nodes})
    EXPECT_EQ(parse_fit_target(to_string(target)), target);
  EXPECT_EQ(default_target(isotropic, {}), FitTarget::nodes);
  EXPECT_EQ(default_target(isotropic, {.form = Budget{}}), FitTarget::nodes);
  EXPECT_EQ(default_target(isotropic, {.form = DefaultBudget{}}), FitTarget::nodes);
  EXPECT_EQ(default_target(isotropic, {.form = DefaultBudget{.scattered = {.cross_validate = true}}}),
            FitTarget::function);
  EXPECT_EQ(default_target(isotropic, {.form = GivenLobes{.model = "q(h) + s(h)"}}), FitTarget::nodes);
  EXPECT_EQ(default_target(isotropic, {.form = Budget{.scattered = {.cross_validate = true}}}),
            FitTarget::function);
  EXPECT_EQ(default_target(isotropic, {.form = FromBook{}}), FitTarget::function);
  EXPECT_EQ(default_target(isotropic, {.form = OneLobe{}}), FitTarget::function);
  EXPECT_EQ(default_target(isotropic, {.form = BaselineMethod{.method = "svd"}}), FitTarget::function);
  EXPECT_EQ(default_target(isotropic, {.symmetrize = false}), FitTarget::function);
  EXPECT_EQ(default_target(anisotropic, {}), FitTarget::function);
  EXPECT_EQ(default_target(merl, {}), FitTarget::function);
  EXPECT_EQ(default_target(merl, {.hold_out = NodePart{}}), FitTarget::nodes);

  BURNISH_SKIP_WHERE_SANITIZED();  // the rest is slow
  const FitOptions small{.form = Budget{.bytes = 1000}, .score = false};
  FitOptions of_function = small;
  of_function.target = FitTarget::function;
  EXPECT_TRUE(fit(isotropic, small).report.nodes);
  EXPECT_LE(
      fetch_count(fit(isotropic, {.form = Budget{.bytes = 16384, .fetches = 2}, .score = false}).model()),
      2u);
  EXPECT_FALSE(fit(isotropic, of_function).report.nodes);
}

TEST(Fit, TakesAThirdFetchWhereTwoLeaveNodesFartherThanWhatIsForetold) {
  BURNISH_SKIP_WHERE_SANITIZED();
  BURNISH_NEEDS_DATA();
  // Two fetches suffice for a felt, but not for a film whose red goes dark.
  for (const auto& [name, enough] : {std::pair{"acrylic_felt_green_rgb", true}, {"chm_mint_rgb", false}}) {
    const Source source = open_source((data_folder() / "rgl" / name).string() + ".bsdf", {});
    const Fit two = fit(source, {.form = Budget{.bytes = 16'384, .fetches = 2}}), made = fit(source, {});
    const NodesReport& nodes = two.report.nodes.value();
    EXPECT_EQ(nodes.at_fitted.relative <= 1.1 * nodes.held_out->relative &&
                  nodes.at_fitted.log_cos <= 1.1 * nodes.held_out->log_cos,
              enough);
    EXPECT_EQ(fetch_count(made.model()), enough ? 2u : 3u);
    EXPECT_EQ(made.report.nodes->at_fitted.relative < nodes.at_fitted.relative, !enough);
  }
}

TEST(Fit, TakesNodesOfAnisotropicSourcesAsTheyAre) {
  const Source source = source_of("patches", patch_table());
  const Fit made = fit(source, {.form = GivenLobes{.model = "p(wo) q(h) p(wi)", .tables = {"p=6x6", "q=8x8"}},
                                .target = FitTarget::nodes});
  ASSERT_TRUE(made.report.nodes);
  EXPECT_FALSE(made.report.nodes->covariance);
  EXPECT_LT(made.report.nodes->at_fitted.relative, 0.5);
}

TEST(Fit, ReflectsWhatTheRawValuesOfANoisySourceDo) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = source_of("noisy", fixtures::noisy_table());
  const SymmetrizedBrdf raw(source.ref());
  for (const Budget budget : {Budget{.bytes = 2700}, Budget{.bytes = 16 << 10, .fetches = 2}}) {
    const Fit made = fit(source, {.form = budget, .score = false});
    for (const double degrees : {0, 15, 30, 45, 60}) {
      const Vec3 wi = spherical_direction(radians(degrees), 0);
      const std::vector<double> expected = directional_albedo(raw, wi, 2e-3).albedo,
                                found = directional_albedo(made.ref(), wi, 2e-3).albedo;
      for (std::size_t c = 0; c < expected.size(); ++c)
        EXPECT_NEAR(found[c] / expected[c], 1, 0.01) << degrees << " degrees, channel " << c;
    }
  }
}

// Relative errors are alike in all channels, and independent for exchanged directions.
Source noisy_source(double noise) {
  AngleTable table = tabulate_angles(paint(), angle_table());
  Pcg32 random(3);
  for (float& value : table.values)
    value *= static_cast<float>(std::exp(noise * fixtures::draw_even(random)));
  return source_of("noisy", std::move(table));
}

TEST(Fit, ChoosesTheSmoothnessOfVolumesByNodesWhereAsked) {
  BURNISH_SKIP_WHERE_SANITIZED();
  AngleTable layout;
  layout.folded = true;
  layout.axes = {make_axis({0}, kTwoPi), make_axis(cell_centres(10, kHalfPi)),
                 make_axis(cell_centres(10, kHalfPi)), make_axis(cell_centres(12, kPi))};
  const char* const ggx = "ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2";
  const Source table = source_of("table", tabulate_angles(parse_analytic(ggx), layout)),
               formula = source_of("formula", parse_analytic(ggx));
  const auto smooth_of = [](const Source& source, bool chosen) {
    const Budget budget{.bytes = 2000, .fetches = 1, .scattered = {.cross_validate = chosen}};
    const Fit made = fit(source, {.form = budget, .score = false});
    return std::get<LobesReport>(made.report.how).smooth;
  };
  EXPECT_FALSE(smooth_of(table, false));
  EXPECT_FALSE(smooth_of(formula, true));  // a formula was not measured
  // Few nodes predict one another best with a function that is smooth between them.
  EXPECT_GT(smooth_of(table, true).value_or(0), 1e-8);
}

TEST(Fit, StoresNoNoiseWhereBytesAreAuto) {
  BURNISH_SKIP_WHERE_SANITIZED();
  // A noisier source needs fewer bytes.
  std::uint64_t before = 1 << 20;
  for (const double noise : {0.05, 0.4}) {
    const Fit made = fit(noisy_source(noise), {.form = Budget{.bytes = {}}});
    ASSERT_TRUE(made.report.budget_choice);
    const BudgetChoice& choice = *made.report.budget_choice;
    ASSERT_TRUE(choice.noise);
    EXPECT_LE(made.bytes(), choice.bytes);
    EXPECT_LE(choice.bytes, before);
    before = choice.bytes;
    if (choice.stop == BudgetStop::noise) {
      EXPECT_LE(choice.trials.back().error.relative, choice.noise->relative);
    }
    EXPECT_NE(to_json(made.report).find("\"budget_choice\""), std::string::npos);
  }
}

TEST(Fit, StopsOfASourceWithoutNoiseWhereLittleIsOff) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = source_of("paint", paint());
  const Fit made = fit(source, {.form = Budget{.bytes = {}}});
  const BudgetChoice& choice = made.report.budget_choice.value();
  EXPECT_EQ(choice.stop, BudgetStop::floor);
  EXPECT_FALSE(choice.noise);
  EXPECT_LE(choice.trials.back().error.relative, 0.005);
  EXPECT_LE(fetch_count(made.model()), 2u);
  // The result is the same as a fit to the chosen bytes.
  const Fit named = fit(source, {.form = Budget{.bytes = choice.bytes, .fetches = 2}, .score = false});
  EXPECT_EQ(made.model(), named.model());
}

TEST(Fit, ChoosesBytesOfScatteredSamplesByCrossValidation) {
  const Source source = source_of("scattered", ScatteredBrdf(measure(paint(), {.count = 400, .noise = 0.2})));
  const Fit made = fit(source, {.form = Budget{.bytes = {}, .scattered = {.reweightings = 0}}});
  EXPECT_EQ(made.report.budget_choice.value().stop, BudgetStop::cross_validation);
  EXPECT_EQ(made.report.budget_choice->bytes, made.bytes());
}

// The compact file is at most 256 bytes and 5 % larger than the tables. It and the native file convert to each
// other's bytes.
void expect_small_twins(const Fit& made, const std::string& what) {
  const std::string native = format_fit(made);
  const Model model = parse_model(memory_file(native));
  std::size_t tables = 0;
  for (const Table& table : model.brdf.tables())
    tables += table.layout.node_count() * texel_bytes(table.format, table.channels);
  EXPECT_LE(format_compact(model).size(), 256 + tables * 105 / 100) << what;
  EXPECT_GT(format_compact(model).size(), tables) << what;
  const std::string compact = format_compact(model, CompactContent::model_and_notes);
  EXPECT_TRUE(format_model(parse_compact(memory_file(compact))) == native) << what;
  EXPECT_TRUE(format_compact(parse_compact(memory_file(compact)), CompactContent::model_and_notes) == compact)
      << what;
  EXPECT_TRUE(parse_compact(memory_file(format_compact(model))).brdf == model.brdf) << what;
}

TEST(Fit, MakesFilesLittleLargerThanTheirTables) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const auto expect_small = [](const AnalyticBrdf& brdf, std::uint64_t bytes, std::optional<int> fetches) {
    expect_small_twins(
        fit(source_of("ggx", brdf), {.form = Budget{.bytes = bytes, .fetches = fetches}, .score = false}),
        fmt::format("{} bytes, {} fetches", bytes, fetches.value_or(0)));
  };
  for (const std::optional<int> fetches : {std::optional(1), std::optional(2), std::optional<int>()})
    expect_small(paint(), 1350, fetches);
  expect_small(brushed(), 1350, 4);
  // These models have volumes.
  expect_small(paint(), 16 << 10, 2);
  expect_small(paint(), 64 << 10, 2);
  expect_small(paint(), 16 << 10, 4);
}

// The model is hemispheres times a volume, and its file is little larger than its tables. More bytes would take
// longer and fit better.
TEST(Fit, HoldsAnAnisotropicHighlightAndWhatIsDiffuse) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = source_of("ggx", parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3"));
  const Fit made = fit(source, {.form = Budget{.bytes = 6 << 10, .fetches = 5}, .score = false});
  EXPECT_LE(made.bytes(), 6u << 10);
  EXPECT_LE(fetch_count(made.model()), 6u);
  const ErrorFigures figures = error_figures(source.ref(), made.ref());
  EXPECT_LE(figures.relative, 0.02);
  EXPECT_GE(figures.psnr, 55);
  expect_small_twins(made, "hemispheres");
}

TEST(Fit, WithoutFetchesTakesThemAtTheKnee) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = source_of("paint", paint());
  const Fit made = fit(source, {.form = Budget{.bytes = 6000}, .score = false});
  const auto& report = std::get<LobesReport>(made.report.how);
  ASSERT_GT(report.fetch_trials.size(), 1u);
  const FetchTrial& chosen = trial_at_knee(report.fetch_trials);
  EXPECT_EQ(fetch_count(made.model()), static_cast<std::size_t>(chosen.fetches));
  EXPECT_LE(made.bytes(), 6000u);
}

TEST(Fit, TakesTheKneeOfAnAnisotropicSourceToo) {
  BURNISH_SKIP_WHERE_SANITIZED();
  Table q{.name = "q",
          .layout = {.shape = TableShape::disk, .width = 24, .height = 24},
          .channels = 1,
          .values = {}};
  for (int y = 0; y < q.layout.height; ++y)
    for (int x = 0; x < q.layout.width; ++x) {
      const Vec3 h = node_direction(q.layout, x, y);
      q.values.push_back(static_cast<float>(0.02 + std::exp(-8 * h.x * h.x - 40 * h.y * h.y)));
    }
  const FactoredBrdf streak(1, {q}, {{{1}, {{.table = 0, .projection = kProjectHalf}}}});
  const Fit made = fit(source_of("streak", streak), {.form = Budget{.bytes = 2500}, .score = false});
  const auto& report = std::get<LobesReport>(made.report.how);
  ASSERT_GT(report.fetch_trials.size(), 1u);
  EXPECT_EQ(fetch_count(made.model()), static_cast<std::size_t>(trial_at_knee(report.fetch_trials).fetches));
  EXPECT_LE(fetch_count(made.model()), 3u);  // tables of the half vector alone
  EXPECT_LE(made.bytes(), 2500u);
}

TEST(Fit, RefusesWhatDoesNotGoTogether) {
  const Source even = source_of("even", paint()), uneven = source_of("uneven", brushed()),
               grey = source_of("grey", patch_table());
  const auto told = [](const Source& source, const FitOptions& options) {
    return error_of([&] { fit(source, options); });
  };
  // These models are invalid, or not of that form.
  EXPECT_THAT(told(even, {.form = OneLobe{.model = "p(wo) q(h) p(wi) + s(h)"}}),
              HasSubstr("one lobe, found 2"));
  EXPECT_NE(told(even, {.form = OneLobe{.model = "p(up)"}}), "");
  EXPECT_NE(told(even, {.form = OneLobe{.tables = {"z=8"}}}), "");
  EXPECT_NE(told(even, {.form = OneLobe{.model = "w(theta_t)", .tables = {"w=8x8"}}}), "");
  EXPECT_NE(told(even, {.form = GivenLobes{.model = ""}}), "");
  // Sources that were not measured have no nodes, and a function has none to hold out.
  EXPECT_THAT(told(even, {.target = FitTarget::nodes}), HasSubstr("expected a measurement"));
  EXPECT_THAT(told(even, {.target = FitTarget::function, .hold_out = NodePart{}}),
              HasSubstr("expected nodes as the target"));
  // These budgets hold no model.
  EXPECT_THAT(told(even, {.form = Budget{.bytes = 0}}), HasSubstr("budget"));
  EXPECT_THAT(told(even, {.form = Budget{.bytes = 20}}), HasSubstr("budget"));
  EXPECT_THAT(told(uneven, {.form = Budget{.lobes = 1}}), HasSubstr("two lobes"));
  EXPECT_THAT(told(even, {.form = Budget{.fetches = 0}}), HasSubstr("at least one fetch, found 0"));
  EXPECT_THAT(told(even, {.form = Budget{.lobes = 0}}), HasSubstr("at least one lobe, found 0"));
  EXPECT_THAT(told(even, {.form = Budget{.fetches = 2, .lobes = 2}}), HasSubstr("no number of lobes"));
  EXPECT_THAT(told(even, {.form = Budget{.fetches = 2, .search = true}}), HasSubstr("and no search"));
  EXPECT_THAT(told(even, {.form = BaselineMethod{"svd", 0}}), HasSubstr("at least one byte"));
  EXPECT_THAT(told(even, {.samples = 0}), HasSubstr("at least one sample"));
  // These formats do not hold the channels.
  EXPECT_THAT(told(grey, {.form = Budget{}, .format = TableFormat::rgb9e5}), HasSubstr("3 channels"));
  EXPECT_NE(told(grey, {.form = OneLobe{.tables = {"p=6x6", "q=8x8"}}, .format = TableFormat::rgb9e5}), "");
  // These numbers are out of range.
  EXPECT_NE(told(even, {.form = OneLobe{}, .smooth = -1, .samples = 100}), "");
  EXPECT_NE(told(even, {.form = OneLobe{.how = {.floor = 0}}, .samples = 100}), "");
  // These are wrong options of baselines.
  EXPECT_THAT(told(even, {.form = BaselineMethod{"pca"}}), HasSubstr("expected one of svd"));
  EXPECT_THAT(told(uneven, {.form = BaselineMethod{"dgf"}, .samples = 100}), HasSubstr("isotropic"));
  EXPECT_THAT(told(even, {.form = BaselineMethod{"svd"}, .smooth = 1e-3}), HasSubstr("method svd"));
  EXPECT_THAT(told(even, {.form = BaselineMethod{"svd"}, .format = TableFormat::half}),
              HasSubstr("method svd"));
  EXPECT_THAT(told(even, {.form = BaselineMethod{"svd"}, .conserve_energy = true}), HasSubstr("method svd"));
}

// Light that goes the other way through a sheet comes from its other side.
TEST(Fit, OfATransmissionKeepsTheOrderOfTheDirectionsAndSaysWhatItIs) {
  const auto through = [](std::span<const DirectionPair> pairs, std::span<double> values) {
    for (std::size_t i = 0; i < pairs.size(); ++i) values[i] = 0.1 + 0.4 * pairs[i].wi.z;
  };
  Source source = to_source("sheet", FunctionBrdf(1, true, through));
  const FitOptions options{
      .form = GivenLobes{.model = "c(theta_i)", .tables = {"c=16"}}, .samples = 20000, .score = false};
  const auto at = [](const Fit& fit, double theta_i, double theta_o) {
    double f;
    fit.ref().eval(spherical_direction(theta_i, 0), spherical_direction(theta_o, 2), {&f, 1});
    return f;
  };
  EXPECT_TRUE(fit(source, options).report.symmetrized);
  source.findings.block = BsdfBlock{BsdfPart::transmission_back, "NIR"};
  const Fit model = fit(source, options);
  EXPECT_FALSE(model.report.symmetrized);
  EXPECT_NEAR(at(model, 0.2, 1.1), 0.1 + 0.4 * std::cos(0.2), 0.02);
  EXPECT_NEAR(at(model, 1.1, 0.2), 0.1 + 0.4 * std::cos(1.1), 0.02);
  EXPECT_THAT(to_json(model.report), testing::HasSubstr(R"("part":"transmission-back","band":"NIR")"));
  EXPECT_EQ(to_source("model", to_model(model)).findings.block, source.findings.block);
}

}  // namespace
}  // namespace burnish
