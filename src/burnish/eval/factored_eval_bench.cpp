// Evaluations a second of factored BRDFs beside tables and a formula, on one thread, three channels, random
// directions: enough of them that a large table is read from where it lies, not from the cache.
#include <array>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

#include <burnish/eval/factored_eval.h>
#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/rgl_builder.h>

namespace burnish {
namespace {

constexpr std::size_t kPairs = 1 << 17, kChecked = 1 << 13;

const std::vector<DirectionPair>& bench_pairs() {
  static const std::vector<DirectionPair> pairs = [] {
    auto drawn = draw_pairs(kPairs, 1, false);
    for (auto& [wi, wo] : drawn)  // to float, for all alike
      for (double* v : {&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z}) *v = static_cast<float>(*v);
    return drawn;
  }();
  return pairs;
}

// The material of every table here.
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
    for (int y = 0; y < t.layout.height; ++y)
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

// One pair at a time. `truth` gives the values to compare with; the mean relative error must be in bound.
template <class Real, class Eval, class Truth>
void one_by_one(benchmark::State& state, const Eval& eval, const Truth& truth, double bound) {
  const auto& pairs = bench_pairs();
  std::array<Real, 3> f;
  double error = 0;
  for (const auto& [wi, wo] : std::span(pairs).first(kChecked)) {
    std::array<double, 3> expected;
    truth.eval(wi, wo, expected);
    eval.eval(wi, wo, f);
    for (std::size_t c = 0; c < 3; ++c) error += std::abs(static_cast<double>(f[c]) / expected[c] - 1);
  }
  error /= 3 * kChecked;
  if (!(error <= bound)) return state.SkipWithError("the values are wrong");
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [wi, wo] = pairs[i++ % kPairs];
    eval.eval(wi, wo, f);
    benchmark::DoNotOptimize(f);
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["relative_error"] = error;
}

void batched(benchmark::State& state, const FactoredBrdf& model) {
  const FactoredEvaluator evaluator(model);
  const auto& pairs = bench_pairs();
  std::vector<float> in[6], f(3 * kPairs);
  for (const auto& [wi, wo] : pairs) {
    const double components[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (int k = 0; k < 6; ++k) in[k].push_back(static_cast<float>(components[k]));
  }
  const DirectionSpans spans{in[0], in[1], in[2], in[3], in[4], in[5]};
  evaluator.eval(spans, f);
  double error = 0;
  for (std::size_t i = 0; i < kChecked; ++i) {
    std::array<double, 3> expected;
    model.eval(pairs[i].wi, pairs[i].wo, expected);
    for (std::size_t c = 0; c < 3; ++c)
      error += std::abs(static_cast<double>(f[c * kPairs + i]) / expected[c] - 1);
  }
  error /= 3 * kChecked;
  if (!(error <= evaluator.rounding_bound())) return state.SkipWithError("the values are wrong");
  for (auto _ : state) {
    evaluator.eval(spans, f);
    benchmark::DoNotOptimize(f.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPairs));
  state.counters["relative_error"] = error;
}

void register_model(const std::string& name, const char* expression,
                    const std::vector<std::string>& options) {
  const FactoredBrdf model = smooth_model(expression, options);
  benchmark::RegisterBenchmark(("eval/" + name + "/reference").c_str(), [model](benchmark::State& state) {
    one_by_one<double>(state, model, model, 0);
  });
  benchmark::RegisterBenchmark(("eval/" + name + "/scalar").c_str(), [model](benchmark::State& state) {
    const FactoredEvaluator evaluator(model);
    one_by_one<float>(state, evaluator, model, evaluator.rounding_bound());
  });
  benchmark::RegisterBenchmark(("eval/" + name + "/batched").c_str(),
                               [model](benchmark::State& state) { batched(state, model); });
}

// Errors of the tables are those of sampling the formula, large in the highlight and at grazing angles.
const bool registered = [] {
  register_model("pqp", "pqp", {"p=32", "q=64,rational:0.1"});
  register_model("pqpr", "pqpr", {"p=32", "q=64,rational:0.1", "r=32"});
  register_model("pqp_disk", "pqp", {"p=64x64", "q=64x64,rational:0.2"});
  benchmark::RegisterBenchmark("eval/ggx",
                               [](benchmark::State& state) { one_by_one<double>(state, ggx(), ggx(), 0); });
  static const auto merl = [] {
    static const HalfDiffTable table = tabulate_half_diff(ggx(), 90, 90, 180, false);
    return &table;
  };
  benchmark::RegisterBenchmark("eval/merl_nearest", [](benchmark::State& state) {
    one_by_one<double>(state, NearestHalfDiff{merl()}, ggx(), 0.1);
  });
  benchmark::RegisterBenchmark("eval/merl_interpolated", [](benchmark::State& state) {
    one_by_one<double>(state, *merl(), ggx(), 0.1);
  });
  benchmark::RegisterBenchmark("eval/rgl", [](benchmark::State& state) {
    static const RglTable table = make_rgl_table(ggx());
    one_by_one<double>(state, table, ggx(), 0.1);
  });
  return true;
}();

}  // namespace
}  // namespace burnish
