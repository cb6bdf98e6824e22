#include "accuracy_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <future>
#include <thread>

#include <fmt/format.h>

#include <burnish/fitting/fit.h>

#include "report_tools.h"

namespace burnish {
namespace {

// Multiply-adds and weights of the 6-21-21-3 network.
constexpr EvaluationCost kNetworkCost{.table_reads = 675, .multiplies = 6 * 21 + 21 * 21 + 21 * 3};
constexpr std::size_t kNetworkBytes = 1350;  // as half floats

Score score_of(const Material& material, std::string_view method, std::size_t budget, BrdfRef model) {
  Score score{
      .method = std::string(method), .budget = budget, .errors = material.scorer.score(model), .picture = {}};
  if (material.shown_budget && budget <= *material.shown_budget)
    score.picture = picture(model, material.scorer.exposure());
  return score;
}

// The figures of a mean, in one place.
std::array<double*, 6> figures(ErrorFigures& e) {
  return {&e.psnr, &e.ssim, &e.relative, &e.log_cos, &e.rms_log, &e.rms};
}

// "ours" or one of the baselines, at so many bytes; 0: whatever it takes.
Score run_method(const Material& material, std::string_view method, std::size_t budget) {
  FitOptions options{.score = false};
  if (method == "ours")
    options.form = Budget{.bytes = budget};
  else
    options.form = BaselineMethod{.method = std::string(method), .bytes = budget};
  const Fit made = fit(material.source, options);
  Score score = score_of(material, method, budget, made.ref());
  score.bytes = made.bytes();
  score.cost = std::visit(
      [](const auto& brdf) -> std::optional<EvaluationCost> { return evaluation_cost(brdf); }, made.brdf);
  score.seconds = made.report.seconds;
  return score;
}

}  // namespace

Image8 picture(BrdfRef brdf, double exposure) {
  return lit_sphere(brdf,
                    {.size = 128, .light_angle = kSphereLights[1], .exposure = exposure, .supersampling = 2});
}

std::vector<std::vector<Score>> run(const std::deque<Material>& materials) {
  struct Job {
    const Material* material;
    std::string_view method;
    std::size_t budget;
    Score* score;
  };
  std::vector<std::vector<Score>> scores;
  std::vector<Job> others;
  for (const Material& material : materials) {
    std::vector<Job> jobs;
    for (const auto& [method, budgets] : material.attempts)
      for (const std::size_t budget : budgets.empty() ? std::vector<std::size_t>{0} : budgets)
        jobs.push_back({&material, method, budget, nullptr});
    fmt::print(stderr, "accuracy: {}\n", material.name);
    std::vector<Score>& row = scores.emplace_back(jobs.size());
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      jobs[k].score = &row[k];
      if (jobs[k].method == "ours")
        row[k] = run_method(material, jobs[k].method, jobs[k].budget);
      else
        others.push_back(jobs[k]);
    }
  }
  // They take one thread each, most of the time.
  std::atomic<std::size_t> next = 0;
  std::vector<std::future<void>> workers;
  for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t k; (k = next++) < others.size();) {
        const auto& [material, method, budget, score] = others[k];
        fmt::print(stderr, "accuracy: {}, {}\n", material->name, method);
        *score = run_method(*material, method, budget);
      }
    }));
  for (std::future<void>& worker : workers) worker.get();
  return scores;
}

Score run_network(const Material& material, BrdfRef network) {
  Score score = score_of(material, "network", 0, network);
  score.bytes = kNetworkBytes;
  score.cost = kNetworkCost;
  return score;
}

void print_head() {
  fmt::print(
      "| material | method | bytes | psnr | ssim | relative | log_cos | rms_log | rms | table reads | "
      "multiplies "
      "| fit seconds |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const std::string& material, const Score& s) {
  const ErrorFigures& e = s.errors;
  fmt::print("| {} | {} | {} | {:.2f} | {:.4f} | {:.4f} | {:.4f} | {:.3f} | {:.3g} | {} | {} | {} |\n",
             material, s.method, s.bytes, e.psnr, e.ssim, e.relative, e.log_cos, e.rms_log, e.rms,
             s.cost ? std::to_string(s.cost->table_reads) : "",
             s.cost ? std::to_string(s.cost->multiplies) : "",
             s.seconds > 0 ? fmt::format("{:.1f}", s.seconds) : "");
  std::fflush(stdout);
}

void Means::add(const std::vector<Score>& scores) {
  for (Score s : scores) {
    const auto known = std::ranges::find_if(
        sums_, [&](const auto& sum) { return sum.first.method == s.method && sum.first.budget == s.budget; });
    if (known == sums_.end()) {
      sums_.emplace_back(std::move(s), 1);
      continue;
    }
    auto& [sum, count] = *known;
    sum.bytes += s.bytes;
    sum.seconds += s.seconds;
    const auto to = figures(sum.errors), from = figures(s.errors);
    for (std::size_t k = 0; k < to.size(); ++k) *to[k] += *from[k];
    if (sum.cost && s.cost) {
      sum.cost->table_reads += s.cost->table_reads;
      sum.cost->multiplies += s.cost->multiplies;
    }
    ++count;
  }
}

std::vector<Score> Means::means() const {
  std::vector<Score> result;
  for (auto [sum, count] : sums_) {
    const auto whole = static_cast<std::size_t>(count);
    sum.bytes /= whole;
    sum.seconds /= count;
    for (double* figure : figures(sum.errors)) *figure /= count;
    if (sum.cost) sum.cost = {sum.cost->table_reads / whole, sum.cost->multiplies / whole};
    result.push_back(std::move(sum));
  }
  return result;
}

}  // namespace burnish
