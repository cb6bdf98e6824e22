// SPDX-License-Identifier: Apache-2.0
// This benchmark draws directions with their densities on one thread, and counts them per second. It compares them
// with evaluation of the same model and with the baselines. The directions wo are random, so that table rows are not
// already in the cache.
#include <algorithm>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

#include <burnish/eval/tabulated_sampler.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/reflectance/rgl_builder.h>

namespace burnish {
namespace {

constexpr std::size_t kCount = 1 << 14;

// wo spread over the hemisphere and uniform points, exact in float.
struct Inputs {
  std::vector<Vec3> wo;
  std::vector<Point2> u;
  std::vector<float> planes[5];
};

const Inputs& inputs() {
  static const Inputs made = [] {
    Inputs in;
    Pcg32 random(1);
    const auto uniform = [&] {
      return static_cast<double>(static_cast<float>(0.9999999 * random.uniform()));
    };
    for (std::size_t i = 0; i < kCount; ++i) {
      const double z = 1 - 0.98 * random.uniform();
      const Vec3 w = spherical_direction(std::acos(z), kTwoPi * random.uniform());
      in.wo.push_back({static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)});
      const double x = uniform();
      in.u.push_back({x, uniform()});
      const double values[] = {in.wo[i].x, in.wo[i].y, in.wo[i].z, in.u[i].x, in.u[i].y};
      for (int k = 0; k < 5; ++k) in.planes[k].push_back(static_cast<float>(values[k]));
    }
    return in;
  }();
  return made;
}

// The disagreement |pdf(wi, wo) / pdf - 1| of the draws.
struct Disagreement {
  double mean = 0;        ///< over draws that stay in their cell
  double at_borders = 0;  ///< the share of the other draws, which rounding moves to the next cell
};
constexpr double kAtBorder = 1e-3, kMaxAtBorders = 5e-3;

template <class Sampler>
Disagreement disagreement(const Sampler& sampler) {
  const Inputs& in = inputs();
  Disagreement found;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const DrawnDirection drawn = sampler.sample_wi(in.wo[i], in.u[i]);
    if (!(drawn.pdf > 0 && drawn.wi.z > 0)) continue;
    const double error = std::abs(sampler.pdf(drawn.wi, in.wo[i]) / drawn.pdf - 1);
    if (!std::isfinite(error)) return {.mean = error, .at_borders = 1};  // no density at all
    if (error < kAtBorder) {
      found.mean += error;
      ++inside;
    } else {
      found.at_borders += 1 / static_cast<double>(kCount);
    }
  }
  found.mean /= static_cast<double>(std::max<std::size_t>(inside, 1));
  return found;
}

// Reports a line: items a second, with the mean relative error of the densities.
void finish(benchmark::State& state, double error, std::size_t items) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
  state.counters["relative_error"] = error;
}

template <class Sampler>
void draw_one_by_one(benchmark::State& state, const Sampler& sampler) {
  const Inputs& in = inputs();
  const auto [error, at_borders] = disagreement(sampler);
  if (!(at_borders < kMaxAtBorders)) return state.SkipWithError("sample and pdf disagree");
  state.counters["at_borders"] = at_borders;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sampler.sample_wi(in.wo[i], in.u[i]));
    i = (i + 1) % kCount;
  }
  finish(state, error, 1);
}

template <class Sampler>
void pdf_one_by_one(benchmark::State& state, const Sampler& sampler) {
  const Inputs& in = inputs();
  std::vector<Vec3> wi;
  for (std::size_t i = 0; i < kCount; ++i) wi.push_back(sampler.sample_wi(in.wo[i], in.u[i]).wi);
  const auto [error, at_borders] = disagreement(sampler);
  if (!(at_borders < kMaxAtBorders)) return state.SkipWithError("sample and pdf disagree");
  state.counters["at_borders"] = at_borders;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sampler.pdf(wi[i], in.wo[i]));
    i = (i + 1) % kCount;
  }
  finish(state, error, 1);
}

// Draws for all inputs, in planes.
struct Batch {
  std::vector<float> out[4] = {std::vector<float>(kCount), std::vector<float>(kCount),
                               std::vector<float>(kCount), std::vector<float>(kCount)};
  std::vector<float> pdf = std::vector<float>(kCount);

  void draw(const TabulatedSampler& sampler) {
    const auto& in = inputs().planes;
    sampler.sample_wi(DrawSpans{in[0], in[1], in[2], in[3], in[4]},
                      DrawnSpans{out[0], out[1], out[2], out[3]});
  }
  DirectionSpans directions() const {
    const auto& in = inputs().planes;
    return {out[0], out[1], out[2], in[0], in[1], in[2]};
  }
  // Returns the error of densities, compared with the scalar form.
  double error(const TabulatedSampler& sampler) const {
    double sum = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      const DrawnDirection one = sampler.sample_wi(inputs().wo[i], inputs().u[i]);
      sum += std::abs(static_cast<double>(out[3][i]) / one.pdf - 1);
    }
    return sum / static_cast<double>(kCount);
  }
};

void draw_batch(benchmark::State& state, const TabulatedSampler& sampler) {
  Batch batch;
  batch.draw(sampler);
  const double error = batch.error(sampler);
  if (!(error < 1e-2)) return state.SkipWithError("batch and scalar disagree");
  for (auto _ : state) {
    batch.draw(sampler);
    benchmark::ClobberMemory();
  }
  finish(state, error, kCount);
}

void pdf_batch(benchmark::State& state, const TabulatedSampler& sampler) {
  Batch batch;
  batch.draw(sampler);
  const double error = batch.error(sampler);
  if (!(error < 1e-2)) return state.SkipWithError("batch and scalar disagree");
  for (auto _ : state) {
    sampler.pdf(batch.directions(), batch.pdf);
    benchmark::ClobberMemory();
  }
  finish(state, error, kCount);
}

void eval_one_by_one(benchmark::State& state, const TabulatedSampler& sampler,
                     const FactoredEvaluator& model) {
  const Inputs& in = inputs();
  std::vector<Vec3> wi;
  for (std::size_t i = 0; i < kCount; ++i) wi.push_back(sampler.sample_wi(in.wo[i], in.u[i]).wi);
  float f[3];
  std::size_t i = 0;
  for (auto _ : state) {
    model.eval(wi[i], in.wo[i], f);
    benchmark::DoNotOptimize(f);
    i = (i + 1) % kCount;
  }
  state.SetItemsProcessed(state.iterations());
}

void eval_batch(benchmark::State& state, const TabulatedSampler& sampler, const FactoredEvaluator& model) {
  Batch batch;
  batch.draw(sampler);
  std::vector<float> f(3 * kCount);
  for (auto _ : state) {
    model.eval(batch.directions(), f);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}

struct Case {
  FactoredBrdf model;
  TabulatedSampler sampler;
  FactoredEvaluator evaluator;

  explicit Case(FactoredBrdf brdf) : model(std::move(brdf)), sampler(model), evaluator(model) {}
};

FactoredBrdf fitted(const char* spec, const char* expression, const std::vector<std::string>& tables) {
  const AnalyticBrdf brdf = parse_analytic(spec);
  const SampleSource source = from_brdf(brdf.ref(), 50'000, 1, false);
  return fit_homomorphic(source, parse_model_spec(expression, tables, brdf.isotropic()), {}).brdf;
}

// Joins the lobes of two models whose tables are disjoint.
FactoredBrdf sum_of(const FactoredBrdf& a, const FactoredBrdf& b) {
  std::vector<Table> tables(a.tables().begin(), a.tables().end());
  std::vector<Lobe> lobes(a.lobes().begin(), a.lobes().end());
  const int shift = static_cast<int>(tables.size());
  for (Table table : b.tables()) {
    table.name += "2";
    tables.push_back(std::move(table));
  }
  for (Lobe lobe : b.lobes()) {
    for (FactorUse& use : lobe.factors) use.table += shift;
    lobes.push_back(std::move(lobe));
  }
  return FactoredBrdf(a.channels(), std::move(tables), std::move(lobes), TableFormat::half);
}

void register_case(const std::string& name, FactoredBrdf model) {
  const auto all = std::make_shared<const Case>(std::move(model));
  const auto add = [&](const char* what, auto run) {
    benchmark::RegisterBenchmark(("sampling/" + name + "/" + what).c_str(),
                                 [all, run](benchmark::State& state) { run(state, *all); });
  };
  add("draw_scalar", [](benchmark::State& s, const Case& c) { draw_one_by_one(s, c.sampler); });
  add("draw_batched", [](benchmark::State& s, const Case& c) { draw_batch(s, c.sampler); });
  add("pdf_scalar", [](benchmark::State& s, const Case& c) { pdf_one_by_one(s, c.sampler); });
  add("pdf_batched", [](benchmark::State& s, const Case& c) { pdf_batch(s, c.sampler); });
  add("eval_scalar", [](benchmark::State& s, const Case& c) { eval_one_by_one(s, c.sampler, c.evaluator); });
  add("eval_batched", [](benchmark::State& s, const Case& c) { eval_batch(s, c.sampler, c.evaluator); });
}

const bool registered = [] {
  constexpr const char* kGlossy = "ggx:alpha_x=0.1,alpha_y=0.1,f0=0.8,kd=0";
  const FactoredBrdf one = fitted(kGlossy, "pqpr", {"p=32", "q=64", "r=32"});
  register_case("one_lobe", one);
  register_case("two_lobes", sum_of(one, fitted("oren_nayar", "pqp", {"p=16", "q=16"})));
  register_case("anisotropic", fitted("ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.1", "pqp",
                                      {"p=64x64", "q=64x64,rational:0.25"}));
  benchmark::RegisterBenchmark("sampling/cosine/draw_scalar",
                               [](benchmark::State& s) { draw_one_by_one(s, CosineSampler{}); });
  benchmark::RegisterBenchmark("sampling/ggx_proxy/draw_scalar", [](benchmark::State& s) {
    draw_one_by_one(s, GgxProxy{{0.1, 0.1}, 0.8});
  });
  benchmark::RegisterBenchmark("sampling/rgl/draw_scalar", [](benchmark::State& s) {
    static const RglTable table = make_rgl_table(parse_analytic(kGlossy).ref());
    draw_one_by_one(s, RglSampler{&table});
  });
  return true;
}();

}  // namespace
}  // namespace burnish
