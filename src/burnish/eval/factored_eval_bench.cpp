// SPDX-License-Identifier: Apache-2.0
// Evaluations a second of factored BRDFs, compared with tables and a formula: one thread, three channels, random
// directions. There are so many directions that large tables are read from memory, not from the cache.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <burnish/baselines/evaluation_cost.h>
#include <burnish/baselines/neural_brdf.h>
#include <burnish/eval/factored_eval.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/rgl_builder.h>

#include "evaluation_peers_bench.h"

namespace burnish {
namespace {

constexpr std::size_t kPairs = 1 << 17, kChecked = 1 << 13;
constexpr double kMaxError = 1e-5;  // mean relative error of an evaluator against the definition

const std::vector<DirectionPair>& bench_pairs() {
  static const std::vector<DirectionPair> pairs = [] {
    auto drawn = draw_pairs(kPairs, 1, false);
    for (auto& [wi, wo] : drawn)  // rounded to float, for all representations
      for (double* v : {&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z}) *v = static_cast<float>(*v);
    return drawn;
  }();
  return pairs;
}

// Returns the material of every table here.
const Ggx& ggx() {
  static const Ggx brdf{.distribution = {0.2, 0.2}, .f0 = {0.9, 0.6, 0.3}, .kd = {0.05, 0.1, 0.2}};
  return brdf;
}

// Smooth tables as a fit makes them: a highlight in the half vector, gentle slopes elsewhere.
FactoredBrdf smooth_model(const char* expression, const std::vector<std::string>& options) {
  const ModelSpec spec = parse_model_spec(expression, options, true);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = 3, .values = {}};
    const double steepness = t.name == "q" ? 100 : 1;
    for (int y = 0; y < t.layout.rows(); ++y)
      for (int x = 0; x < t.layout.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const Vec3 w = node_direction(t.layout, x, y);
          table.values.push_back(
              static_cast<float>(-std::log1p(steepness * (w.x * w.x + (1 + 0.1 * c) * w.y * w.y))));
        }
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes) lobes.push_back({.scale = {1, 1.1, 1.2}, .factors = factors});
  return from_log_tables(3, std::move(tables), std::move(lobes), TableFormat::half);
}

// Returns the mean relative error over the first pairs; `value(i)` gives pair i's three channels.
template <class Value, class Truth>
double relative_error(const Value& value, const Truth& truth) {
  double error = 0;
  for (std::size_t i = 0; i < kChecked; ++i) {
    const auto& [wi, wo] = bench_pairs()[i];
    std::array<double, 3> expected;
    truth.eval(wi, wo, expected);
    const auto got = value(i);
    for (std::size_t c = 0; c < 3; ++c)
      error += std::abs(static_cast<double>(got[c]) - expected[c]) / (expected[c] + 1e-6);
  }
  return error / (3 * kChecked);
}

const Ggx& ggx();
const NeuralBrdf& neural();

// Returns the time of `run` over that of `baseline`, each the shortest of several turns. Other load of the machine
// affects both alike.
template <class Run, class Baseline>
double ratio(const Run& run, const Baseline& baseline) {
  const auto seconds = [](const auto& f) {
    const auto start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double least = seconds(run), least_baseline = seconds(baseline);
  for (int turn = 0; turn < 30; ++turn) {
    least = std::min(least, seconds(run));
    least_baseline = std::min(least_baseline, seconds(baseline));
  }
  return least / least_baseline;
}

// Hides a BRDF from the compiler, as in renderers: neither its type nor its parameters are known.
BrdfRef unknown(BrdfRef brdf) {
  benchmark::DoNotOptimize(brdf);
  return brdf;
}

// Evaluates one pair at a time. `truth` gives the values to compare with.
template <class Eval>
void one_by_one(benchmark::State& state, const Eval& eval, BrdfRef truth, double bound) {
  const auto& pairs = bench_pairs();
  std::array<double, 3> f;
  const double error = relative_error(
      [&](std::size_t i) {
        eval.eval(pairs[i].wi, pairs[i].wo, f);
        return f;
      },
      truth);
  if (!(error <= bound)) return state.SkipWithError("the values are wrong");
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [wi, wo] = pairs[i++ % kPairs];
    eval.eval(wi, wo, f);
    benchmark::DoNotOptimize(f);
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["relative_error"] = error;
  const auto all_of = [&](const auto& brdf) {
    return [&pairs, &brdf] {
      std::array<double, 3> values;
      for (std::size_t k = 0; k < kChecked; ++k) {
        brdf.eval(pairs[k].wi, pairs[k].wo, values);
        benchmark::DoNotOptimize(values);
      }
    };
  };
  const BrdfRef formula = unknown(ggx());
  state.counters["of_ggx"] = ratio(all_of(eval), all_of(formula));
}
void one_by_one(benchmark::State& state, BrdfRef eval, double bound) {
  one_by_one(state, unknown(eval), eval, bound);
}

// Evaluates all pairs at once by run(directions, f).
template <class Run, class Truth>
void batched(benchmark::State& state, const Run& run, const Truth& truth, double bound) {
  static const std::array<std::vector<float>, 6> in = [] {
    std::array<std::vector<float>, 6> components;
    for (const auto& [wi, wo] : bench_pairs()) {
      const double w[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (std::size_t k = 0; k < 6; ++k) components[k].push_back(static_cast<float>(w[k]));
    }
    return components;
  }();
  const DirectionSpans spans{in[0], in[1], in[2], in[3], in[4], in[5]};
  std::vector<float> f(3 * kPairs);
  run(spans, std::span(f));
  const double error = relative_error(
      [&](std::size_t i) {
        return std::array{f[i], f[kPairs + i], f[2 * kPairs + i]};
      },
      truth);
  if (!(error <= bound)) return state.SkipWithError("the values are wrong");
  for (auto _ : state) {
    run(spans, std::span(f));
    benchmark::DoNotOptimize(f.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPairs));
  state.counters["relative_error"] = error;
  state.counters["of_network"] =
      ratio([&] { run(spans, std::span(f)); }, [&] { eval_neural(neural().weights(), spans, f); });
}

template <class F>
void add(const std::string& name, const F& f) {
  benchmark::RegisterBenchmark(("eval/" + name).c_str(), f);
}

void add_model(const std::string& name, const char* expression, const std::vector<std::string>& options) {
  const FactoredBrdf model = smooth_model(expression, options);
  const FactoredEvaluator evaluator(model);
  add(name + "/reference", [=](benchmark::State& state) { one_by_one(state, BrdfRef(model), 0); });
  add(name + "/one_by_one",
      [=](benchmark::State& state) { one_by_one(state, unknown(evaluator), model, kMaxError); });
  add(name + "/batched", [=](benchmark::State& state) {
    const auto run = [&](const DirectionSpans& w, std::span<float> f) { evaluator.eval(w, f); };
    batched(state, run, model, kMaxError);
    state.counters["bytes"] = static_cast<double>(model.bytes());
    state.counters["multiplies"] = static_cast<double>(evaluation_cost(model).multiplies);
  });
}

// A fit of a measured file in BURNISH_DATA, or else of the formula. It is made when its first row runs.
struct Fitted {
  FactoredBrdf model;
  FactoredEvaluator evaluator;
};
Source measured() {
  const char* const folder = std::getenv("BURNISH_DATA");
  std::vector<std::string> files;
  if (folder && std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".bsdf") files.push_back(entry.path().string());
  if (files.empty()) return open_source("ggx:alpha_x=0.2,alpha_y=0.2,f0=0.9/0.6/0.3,kd=0.05/0.1/0.2", {});
  return open_source(*std::ranges::min_element(files), {});
}

void add_fit(const std::string& name, const FitForm& form) {
  const auto fitted = std::make_shared<std::optional<Fitted>>();
  const auto made = [=]() -> const Fitted& {
    if (!*fitted) {
      FactoredBrdf model =
          fit(measured(), {.form = form, .target = FitTarget::function, .score = false}).model();
      const FactoredEvaluator evaluator(model);
      fitted->emplace(std::move(model), evaluator);
    }
    return **fitted;
  };
  const auto finish = [](benchmark::State& state, const FactoredBrdf& model) {
    std::size_t lookups = 0;
    for (const Lobe& lobe : model.lobes()) lookups += lobe.factors.size();
    state.counters["lookups"] = static_cast<double>(lookups);
    state.counters["bytes"] = static_cast<double>(model.bytes());
  };
  add(name + "/one_by_one", [=](benchmark::State& state) {
    const auto& [model, evaluator] = made();
    one_by_one(state, unknown(evaluator), model, kMaxError);
    finish(state, model);
  });
  add(name + "/batched", [=](benchmark::State& state) {
    const auto& [model, evaluator] = made();
    const auto run = [&](const DirectionSpans& w, std::span<float> f) { evaluator.eval(w, f); };
    batched(state, run, model, kMaxError);
    finish(state, model);
  });
}

// Tables of a microfacet model, sampled from the formula.
const TabulatedMicrofacets& tabulated_microfacets() {
  static const TabulatedMicrofacets brdf = [] {
    TabulatedMicrofacets b{.diffuse = {0.05f, 0.1f, 0.2f}};
    for (std::size_t c = 0; c < 3; ++c)
      for (int k = 0; k < TabulatedMicrofacets::kAngles; ++k) {
        const double theta = k * kHalfPi / (TabulatedMicrofacets::kAngles - 1);
        const Vec3 w = spherical_direction(theta, 0);
        b.d[c].push_back(static_cast<float>(ggx().distribution.density(w)));
        b.f[c].push_back(static_cast<float>(fresnel_schlick(ggx().f0, w.z).r));
        b.g[c].push_back(static_cast<float>(w.z / ggx().distribution.projected_area(w)));
      }
    return b;
  }();
  return brdf;
}

// A network of small random weights whose outputs are positive.
const NeuralBrdf& neural() {
  static const NeuralBrdf brdf = [] {
    Pcg32 random(7);
    std::vector<float> weights(NeuralBrdf::kWeights);
    for (float& w : weights) w = static_cast<float>(0.4 * random.uniform() - 0.2);
    for (std::size_t c = 0; c < 3; ++c) weights[NeuralBrdf::kWeights - 3 + c] = 1;
    return NeuralBrdf(weights);
  }();
  return brdf;
}

const HalfDiffTable& merl() {
  static const HalfDiffTable table = tabulate_half_diff(ggx(), 90, 90, 180, false);
  return table;
}

// Adds the peers: in float, as fast as a page of code can be, and in double as the library has them. Errors of the
// tables come from sampling the formula; they are large in the highlight and at grazing angles.
void add_peers() {
  add("neural/one_by_one", [](benchmark::State& state) { one_by_one(state, BrdfRef(neural()), 0); });
  add("neural/batched", [](benchmark::State& state) {
    const auto run = [](const DirectionSpans& w, std::span<float> f) {
      eval_neural(neural().weights(), w, f);
    };
    batched(state, run, neural(), 1e-5);
  });
  add("tabulated_microfacets/batched", [](benchmark::State& state) {
    const auto run = [](const DirectionSpans& w, std::span<float> f) {
      eval_tabulated(tabulated_microfacets(), w, f);
    };
    batched(state, run, tabulated_microfacets(), 1e-4);
  });
  add("ggx/one_by_one", [](benchmark::State& state) { one_by_one(state, BrdfRef(ggx()), 0); });
  add("ggx/inlined", [](benchmark::State& state) { one_by_one(state, ggx(), ggx(), 0); });
  add("ggx/batched", [](benchmark::State& state) {
    const auto run = [](const DirectionSpans& w, std::span<float> f) { eval_ggx(ggx(), w, f); };
    batched(state, run, ggx(), 1e-5);
  });
  add("merl_nearest/one_by_one", [](benchmark::State& state) {
    const NearestHalfDiff table{&merl()};
    one_by_one(state, unknown(table), ggx(), 0.1);
  });
  add("merl_nearest/batched", [](benchmark::State& state) {
    const auto run = [](const DirectionSpans& w, std::span<float> f) { eval_nearest(merl(), w, f); };
    batched(state, run, ggx(), 0.1);
  });
  add("merl_interpolated/one_by_one",
      [](benchmark::State& state) { one_by_one(state, unknown(merl()), ggx(), 0.1); });
  add("rgl/one_by_one", [](benchmark::State& state) {
    static const RglTable table = make_rgl_table(ggx());
    one_by_one(state, unknown(table), ggx(), 0.1);
  });
}

// Adds the machine's limits: pairs of nodes read at random from tables as large as a model's, and multiply-adds. A
// disk takes two pairs of nodes a lookup.
void add_limits() {
  for (const std::size_t nodes : {std::size_t{128}, std::size_t{2 * 64 * 64}})
    add(fmt::format("limit/node_pairs_of_{}", nodes), [=](benchmark::State& state) {
      const std::vector<float> table(4 * nodes, 1.0f);
      std::vector<std::int32_t> place(1 << 14);
      Pcg32 random(3);
      for (std::int32_t& p : place)
        p = 4 * static_cast<std::int32_t>(random.uniform() * static_cast<double>(nodes - 1));
      for (auto _ : state) benchmark::DoNotOptimize(load_nodes(table, place));
      state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(place.size()));
    });
  add("limit/multiply_adds", [](benchmark::State& state) {
    std::array<float, 64> last{};
    std::size_t count = 0;
    for (auto _ : state) {
      count += multiply_add(1000, 0.5f, last);
      benchmark::DoNotOptimize(last);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(count));
  });
}

const bool registered = [] {
  add_model("pqr_1k", "p(wo) q(h) r(theta_d) p(wi)", {"p=32", "q=96,rational:0.1", "r=40"});
  add_model("lines_2k7", "p(wo) q(h) r(theta_d) p(wi) + s(wo) t(h) u(theta_d) s(wi)",
            {"p=40", "q=128,rational:0.05", "r=48", "s=40", "t=128,rational:0.3", "u=48"});
  add_model("grid_2k7", "p(wo) q(theta_h,theta_d) p(wi) + s(wo) s(wi)",
            {"p=32", "q=48x8,rational:0.1", "s=24"});
  add_model("pqp_64x64", "pqp", {"p=64x64", "q=64x64,rational:0.2"});
  for (const int fetches : {2, 4, 6, 24})
    add_fit(fmt::format("fit_{}_fetches", fetches), Budget{.bytes = 16 * 1024, .fetches = fetches});
  add_fit("fit_64k", Budget{.bytes = 64 * 1024, .fetches = 2});
  add_fit("fit_2k7", Budget{.bytes = 2700});
  add_peers();
  add_limits();
  return true;
}();

}  // namespace
}  // namespace burnish
