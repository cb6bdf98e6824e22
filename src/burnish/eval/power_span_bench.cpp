// Speed beside error of every way to c^e, in one run. Answers are checked against the double power before
// anything is timed. The printed table takes the least of the repetitions and gives ratios to powf of the
// same memory level; `--benchmark_filter` and the other flags of Google Benchmark work.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>
#include <string>

#include <benchmark/benchmark.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <burnish/eval/power_span.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>

#include "power_baselines_bench.h"

namespace burnish {
namespace {

constexpr double kExponent = 50;

struct Level {
  const char* name;
  std::size_t count;  // floats in, as many out
};
constexpr Level kLevels[] = {{"L1", 2048}, {"L2", 65536}, {"RAM", std::size_t{1} << 24}};

// Whole pages: every vector in one cache line, and no store shortly before a load at the same place of
// another page, for which loads wait.
template <class T>
struct PageAllocator {
  using value_type = T;
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{4096}));
  }
  void deallocate(T* p, std::size_t) noexcept { ::operator delete (p, std::align_val_t{4096}); }
  friend bool operator==(PageAllocator, PageAllocator) { return true; }
};
using Floats = std::vector<float, PageAllocator<float>>;

// Cosines as a lit sphere gives them: half over [0, 1], half inside the highlight.
Floats bench_cosines(std::size_t count) {
  Pcg32 random(11);
  Floats c(count);
  for (float& x : c) {
    const double u = random.uniform();
    x = static_cast<float>(random.next() % 2 ? u : 1 - 8 / kExponent * u);
  }
  return c;
}

using Run = std::function<void(std::span<const float>, std::span<float>)>;

double largest_error(std::span<const float> c, std::span<const float> out) {
  double worst = 0;
  for (std::size_t i = 0; i < c.size(); ++i)
    worst = std::max(worst, std::abs(out[i] - std::pow(static_cast<double>(c[i]), kExponent)));
  return worst;
}

std::map<std::string, double>& errors() {
  static std::map<std::string, double> all;
  return all;
}

// Registers one way at every memory level, after its answers were found within `allowed`.
void add(const std::string& name, double allowed, const Run& run) {
  const Floats probe = bench_cosines(4096);
  Floats answer(probe.size());
  run(probe, answer);
  const double error = allowed < 0 ? -1 : largest_error(probe, answer);
  if (error > allowed) {
    std::fprintf(stderr, "%s: error %g, allowed %g\n", name.c_str(), error, allowed);
    std::exit(1);
  }
  errors()[name] = error;
  for (const Level& level : kLevels)
    benchmark::RegisterBenchmark((name + "/" + level.name).c_str(), [=](benchmark::State& state) {
      const Floats c = bench_cosines(level.count);
      Floats out(c.size());
      for (auto _ : state) {
        run(c, out);
        benchmark::ClobberMemory();
      }
      state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(c.size()));
      state.counters["max_error"] = error;
    });
}

void add_shading(const std::string& name, std::optional<PowerMethod> method) {
  constexpr std::size_t kCount = 2048;
  BlinnPhongShading material{0.4f, 0.6f, {}, spherical_direction(0.5, 0), spherical_direction(0.2, 1)};
  if (method) material.power = power_coefficients(*method, kExponent);
  Pcg32 random(12);
  Floats x(kCount), y(kCount), z(kCount), out(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    const Vec3 n = (0.8 + 0.2 * random.uniform()) *
                   spherical_direction(kHalfPi * random.uniform(), kTwoPi * random.uniform());
    x[i] = static_cast<float>(n.x);
    y[i] = static_cast<float>(n.y);
    z[i] = static_cast<float>(n.z);
  }
  shade_blinn_phong(material, {x, y, z}, out);
  const Vec3 h = half_vector(material.wi, material.wo);
  double error = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Vec3 n = normalize({x[i], y[i], z[i]});
    const double c = std::max(0.0, dot(n, h)), power = method ? std::pow(c, kExponent) : c;
    error = std::max(error, std::abs(out[i] - (0.4 * std::max(0.0, dot(n, material.wi)) + 0.6 * power)));
  }
  const double allowed = method ? 0.6 * power_bound(*method, kExponent) + 2e-5 : 2e-6;
  if (error > allowed) {
    std::fprintf(stderr, "%s: error %g, allowed %g\n", name.c_str(), error, allowed);
    std::exit(1);
  }
  errors()[name] = error;
  benchmark::RegisterBenchmark((name + "/L1").c_str(), [=](benchmark::State& state) {
    Floats result(kCount);
    for (auto _ : state) {
      shade_blinn_phong(material, {x, y, z}, result);
      benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
    state.counters["max_error"] = error;
  });
}

// The way a benchmark of this file times: its name without the memory level.
std::string way_of(const std::string& name) {
  return name.substr(0, name.rfind('/'));
}

// Keeps the least time a value of each benchmark of this file and prints the table at the end; the benchmarks
// of other files are printed as usual.
class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    if (!runs.empty() && !errors().count(way_of(runs.front().run_name.function_name))) {
      ConsoleReporter::ReportRuns(runs);
      return;
    }
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const double ns = 1e9 / run.counters.at("items_per_second");
      const auto [at, fresh] = least_.try_emplace(run.run_name.function_name, ns);
      if (fresh) order_.push_back(run.run_name.function_name);
      at->second = std::min(at->second, ns);
    }
  }
  void Finalize() override {
    if (order_.empty()) return;
    std::printf("%-28s %10s %10s %12s %12s\n", "way/level", "ns/value", "max error", "x of powf",
                "/ fma_loop");
    for (const std::string& name : order_) {
      const std::string way = way_of(name), level = name.substr(way.size());
      std::printf("%-28s %10.4f", name.c_str(), least_[name]);
      const double error = errors()[way];
      if (error < 0)
        std::printf(" %10s", "no power");
      else
        std::printf(" %10.2g", error);
      const bool shading = way.rfind("shade_", 0) == 0;
      const std::string base = shading ? "shade_no_power" : "powf";
      if (least_.count(base + level)) std::printf(" %12.2f", least_[base + level] / least_[name]);
      if (!shading && least_.count("fma_loop" + level))
        std::printf(" %12.2f", least_[name] / least_["fma_loop" + level]);
      std::printf("\n");
    }
  }

 private:
  std::map<std::string, double> least_;
  std::vector<std::string> order_;
};

void add_all() {
  for (const PowerBaseline& baseline : power_baselines())
    add(baseline.name, baseline.allowed_error,
        [run = baseline.run](std::span<const float> c, std::span<float> out) {
          run(c, static_cast<float>(kExponent), out);
        });
  if (!power_baselines().empty())
    add("fma_loop", -1, [](std::span<const float> c, std::span<float> out) { fma_loop(c, 0.75f, out); });
  for (const PowerInfo& info : power_methods()) {
    if (info.method == PowerMethod::quadratic_raw) continue;  // as fast as quadratic, not a power
    const double allowed = power_bound(info.method, kExponent) + power_span_rounding(info.method, false);
    const std::string name = info.method == PowerMethod::exact ? "highway_exp_log" : std::string(info.name);
    add(name, allowed,
        [k = power_coefficients(info.method, kExponent)](std::span<const float> c, std::span<float> out) {
          power_span(k, c, out);
        });
  }
  static const Floats exponents(kLevels[2].count, static_cast<float>(kExponent));
  for (PowerMethod method :
       {PowerMethod::quadratic, PowerMethod::w8, PowerMethod::cubic2, PowerMethod::near_exact})
    add(std::string(power_info(method).name) + "_per_value",
        power_bound(method, kExponent) + power_span_rounding(method, true),
        [method](std::span<const float> c, std::span<float> out) {
          power_span(method, c, std::span(exponents).first(c.size()), out);
        });
  add_shading("shade_no_power", {});
  for (PowerMethod method : {PowerMethod::quadratic, PowerMethod::w8, PowerMethod::cubic2,
                             PowerMethod::cubic4, PowerMethod::near_exact, PowerMethod::exact})
    add_shading("shade_" + std::string(power_info(method).name), method);
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  static char repetitions[] = "--benchmark_repetitions=9", time[] = "--benchmark_min_time=0.02",
              interleave[] = "--benchmark_enable_random_interleaving=true";
  arguments.insert(arguments.begin() + 1, {repetitions, time, interleave});  // later flags win
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  const char* flush = std::getenv("BURNISH_BENCH_FLUSH_DENORMALS");
  const char* target = std::getenv("BURNISH_BENCH_TARGET");
  const burnish::SimdTargetLimit limit(target ? target : burnish::simd_targets().front());
#if defined(__x86_64__)
  if (flush) _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
#endif
  std::printf("exponent %g, denormals %s, target %s\n", burnish::kExponent, flush ? "flushed" : "kept (IEEE)",
              burnish::simd_targets().front().c_str());
  burnish::add_all();
  burnish::TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
