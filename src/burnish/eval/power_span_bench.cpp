// SPDX-License-Identifier: Apache-2.0
// Speed and error of every way to compute c^e, in one run. Answers are checked against the double power before
// timing. The printed table uses the shortest of the repetitions and gives three ratios for each way: its speed over
// that of the baseline (named by BURNISH_BENCH_BASELINE, by default highway_fastpow_false); its time in multiply-adds
// over memory; and its time over the limit, a copy or its own multiply-adds and compares at the processor's full
// rate. Each ratio compares ways of one target and memory level. `--benchmark_filter` and the other flags of Google
// Benchmark work.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <burnish/eval/power_span.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>

#include "power_baselines_bench.h"
#include "power_rivals_bench.h"

namespace burnish {
namespace {

constexpr double kExponent = 50;

struct Level {
  const char* name;
  std::size_t count;  // floats in, as many out
};
constexpr Level kLevels[] = {{"L1", 2048}, {"L2", 65536}, {"RAM", std::size_t{1} << 24}};

// Allocates whole pages, so that every vector lies in one cache line. It also avoids stores shortly before a load at
// the same place of another page, for which loads would wait.
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

// The properties of a way before it is timed; both errors are -1 if it is no power.
struct Way {
  double error = -1;           // largest |answer - power|
  double relative_error = -1;  // largest |answer / power - 1| where the power is at least 1/255
  int operations = 0;          // multiply-adds and compares a value, 0: not counted
  std::string target;          // "avx2", "avx512" or none
};

std::map<std::string, Way>& ways() {
  static std::map<std::string, Way> all;
  return all;
}

Way measured_way(std::span<const float> c, std::span<const float> out) {
  Way way{0, 0, 0, {}};
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double power = std::pow(static_cast<double>(c[i]), kExponent), error = std::abs(out[i] - power);
    way.error = std::max(way.error, error);
    if (power >= 1.0 / 255) way.relative_error = std::max(way.relative_error, error / power);
  }
  return way;
}

// Returns "avx2" or "avx512" if the name ends so.
std::string target_of(const std::string& name) {
  for (const char* target : {"avx2", "avx512"})
    if (name.ends_with(target)) return target;
  return {};
}

// Registers one way at every memory level, once its answers are within `allowed`; `simd` limits the library's
// kernels.
void add(const std::string& name, double allowed, const Run& run, int operations = 0,
         const std::optional<std::string>& simd = {}) {
  const Floats probe = bench_cosines(4096);
  Floats answer(probe.size());
  const auto limit = [=] {
    return simd ? std::make_unique<SimdTargetLimit>(*simd) : std::unique_ptr<SimdTargetLimit>();
  };
  {
    const auto held = limit();
    run(probe, answer);
  }
  Way way = allowed < 0 ? Way{} : measured_way(probe, answer);
  if (way.error > allowed && allowed >= 0) {
    std::fprintf(stderr, "%s: error %g, allowed %g\n", name.c_str(), way.error, allowed);
    std::exit(1);
  }
  way.operations = operations;
  way.target = target_of(name);
  ways()[name] = way;
  for (const Level& level : kLevels)
    benchmark::RegisterBenchmark((name + "/" + level.name).c_str(), [=](benchmark::State& state) {
      const auto held = limit();
      const Floats c = bench_cosines(level.count);
      Floats out(c.size());
      for (auto _ : state) {
        run(c, out);
        benchmark::ClobberMemory();
      }
      state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(c.size()));
      state.counters["max_error"] = way.error;
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
  ways()[name] = {error, -1, 0, {}};
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

// Returns the way that a benchmark of this file times: its name without the memory level.
std::string way_of(const std::string& name) {
  return name.substr(0, name.rfind('/'));
}

// Keeps the least time a value of each benchmark of this file and prints the table at the end; the benchmarks
// of other files are printed as usual.
class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    if (!runs.empty() && !ways().count(way_of(runs.front().run_name.function_name))) {
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
    std::printf("%-36s %9s %10s %10s %8s %8s %8s\n", "way/level", "ns/value", "max error", "relative",
                ("x " + base_).c_str(), "/ fma", "/ limit");
    for (const std::string& name : order_) print_row(name);
  }

 private:
  // Returns the time of a way of the same target and level, 0 if it was not run.
  double time_of(const std::string& way, const std::string& target, const std::string& level) const {
    const auto at = least_.find(way + (target.empty() ? "" : "_" + target) + level);
    return at == least_.end() ? 0 : at->second;
  }
  // Returns the least time of any loop with `operations` multiply-adds a value: the copy's time or that of the
  // arithmetic.
  double limit_of(const Way& way, const std::string& level) const {
    const double per_operation =
        (time_of("fma_x16", way.target, level) - time_of("fma", way.target, level)) / 15;
    return std::max(time_of("copy", way.target, level), way.operations * per_operation);
  }
  void print_row(const std::string& name) const {
    const auto print = [](bool known, const char* format, double x) {
      if (known)
        std::printf(format, x);
      else
        std::printf(" %*s", std::string(format).find("10") == std::string::npos ? 8 : 10, "-");
    };
    const std::string way_name = way_of(name), level = name.substr(way_name.size());
    const Way& way = ways().at(way_name);
    const double time = least_.at(name);
    const bool shading = way_name.starts_with("shade_");
    std::printf("%-36s %9.4f", name.c_str(), time);
    print(way.error >= 0, " %10.2g", way.error);
    print(way.relative_error >= 0, " %10.2g", way.relative_error);
    const double base = shading ? time_of("shade_no_power", "", level) : time_of(base_, way.target, level);
    print(base > 0, " %8.2f", base / time);
    const double fma = time_of("fma", way.target, level), limit = way.operations ? limit_of(way, level) : 0;
    print(fma > 0 && !shading, " %8.2f", time / fma);
    print(limit > 0, " %8.2f", time / limit);
    std::printf("\n");
  }

  const char* wanted_base_ = std::getenv("BURNISH_BENCH_BASELINE");
  const std::string base_ = wanted_base_ ? wanted_base_ : "highway_fastpow_false";
  std::map<std::string, double> least_;
  std::vector<std::string> order_;
};

// Adds one of the library's members for one target, with one exponent for all values. If `exponents` is long enough,
// it also adds the member with one exponent a value.
void add_member(const PowerInfo& info, const std::string& simd, const std::string& target,
                std::span<const float> exponents) {
  const double bound = power_bound(info.method, kExponent);
  const std::string name(info.name);
  const int operations = info.cost.multiplies + info.cost.compares;  // adds are fused into multiplies
  add(
      name + target, bound + power_span_rounding(info.method, false),
      [k = power_coefficients(info.method, kExponent)](std::span<const float> c, std::span<float> out) {
        power_span(k, c, out);
      },
      operations, simd);
  using M = PowerMethod;
  for (M method : {M::quadratic, M::w8, M::cubic2, M::near_exact, M::exact})
    if (info.method == method)
      add(
          name + "_per_value" + target, bound + power_span_rounding(method, true),
          [=](std::span<const float> c, std::span<float> out) {
            power_span(method, c, exponents.first(c.size()), out);
          },
          operations, simd);
}

void add_all() {
  std::vector<PowerBaseline> others = power_limits();
  if (!others.empty())  // otherwise this processor lacks what they need
    for (const auto& more : {power_baselines(), highway_rivals()})
      others.insert(others.end(), more.begin(), more.end());
  for (const PowerBaseline& other : others)
    add(other.name, other.allowed_error, [run = other.run](std::span<const float> c, std::span<float> out) {
      run(c, static_cast<float>(kExponent), out);
    });
  static const Floats exponents(kLevels[2].count, static_cast<float>(kExponent));
  for (const PowerInfo& info : power_methods()) {
    if (info.method == PowerMethod::quadratic_raw) continue;  // it is as fast as quadratic, and no power
    bool any = false;
    for (const std::string& simd : simd_targets()) {
      const std::string target = simd == "AVX2" ? "_avx2" : simd == "AVX3" ? "_avx512" : "";
      if (target.empty()) continue;
      any = true;
      add_member(info, simd, target, exponents);
    }
    if (!any) add_member(info, simd_targets().front(), "", exponents);
  }
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
  std::optional<burnish::SimdTargetLimit> limit;
  if (target) limit.emplace(target);
#if defined(__x86_64__)
  if (flush) _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
#endif
  std::printf("exponent %g, denormals %s, best target %s, Highway's own powers %s, SLEEF %s\n",
              burnish::kExponent, flush ? "flushed" : "kept (IEEE)", burnish::simd_targets().front().c_str(),
              burnish::highway_rival_version().c_str(), BURNISH_SLEEF_VERSION);
  burnish::add_all();
  burnish::TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
