#include "accuracy_scores.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <future>
#include <thread>

#include <fmt/format.h>

#include <burnish/factors/table_format.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/plans/overfit.h>
#include <burnish/fitting/plans/search.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/reflectance/sample_source.h>

#include "report.h"

namespace burnish::reports {

namespace {

// Multiply-adds and weights of the 6-21-21-3 network.
constexpr EvaluationCost kNetworkCost{.table_reads = 675, .multiplies = 6 * 21 + 21 * 21 + 21 * 3};
constexpr std::size_t kNetworkBytes = 1350;  // as half floats
constexpr std::size_t kDrawnPairs = 200'000;

FactoredBrdf fit_ours(BrdfRef reference, std::size_t bytes) {
  const int channels = reference.channels();
  const TableFormat format = channels == 3 ? TableFormat::rgb9e5 : TableFormat::half;
  const std::size_t texel = texel_bytes(format, channels);
  const TrainingOptions drawn = training_for(bytes, texel, reference.isotropic());
  const TrainingSet set = draw_training_set(reference, drawn);
  RefineOptions options{.format = format};
  const LobePlan plan = plan_for(reference, set, bytes, 0, texel, options);
  const LobesFit fit = fit_without_overfit(reference, set, plan, bytes, texel, drawn, options);
  return to_rounded_brdf(fit.model, set, options);
}

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

Score run_ours(const Material& material, std::size_t budget) {
  const Stopwatch watch;
  const FactoredBrdf brdf = fit_ours(material.reference, budget);
  const double seconds = watch.seconds();
  Score score = score_of(material, "ours", budget, brdf);
  score.bytes = brdf.bytes();
  score.cost = evaluation_cost(brdf);
  score.seconds = seconds;
  return score;
}

Score run_baseline(const Material& material, std::string_view method, std::size_t budget) {
  BaselineOptions options;
  if (budget > 0) options.budget = budget;
  const BaselineFit fit =
      fit_baseline(material.reference, from_brdf(material.reference, kDrawnPairs, 1, false), method, options);
  Score score = score_of(material, method, budget, baseline_ref(fit.baseline.brdf));
  score.bytes = fit.bytes;
  score.cost = fit.cost;
  score.seconds = fit.seconds;
  return score;
}

std::vector<std::string> with_figures(std::vector<std::string> head) {
  for (const char* name : {"bytes", "psnr", "ssim", "relative", "log_cos", "rms_log", "rms", "table reads",
                           "multiplies", "fit seconds"})
    head.emplace_back(name);
  return head;
}

std::vector<std::string> with_figures(std::vector<std::string> cells, const Score& s) {
  const ErrorFigures& e = s.errors;
  for (const std::string& text :
       std::array{fmt::format("{}", s.bytes), fmt::format("{:.2f}", e.psnr), fmt::format("{:.4f}", e.ssim),
                  fmt::format("{:.4f}", e.relative), fmt::format("{:.4f}", e.log_cos),
                  fmt::format("{:.3f}", e.rms_log), fmt::format("{:.3g}", e.rms),
                  s.cost ? std::to_string(s.cost->table_reads) : "",
                  s.cost ? std::to_string(s.cost->multiplies) : "",
                  s.seconds > 0 ? fmt::format("{:.1f}", s.seconds) : ""})
    cells.push_back(text);
  return cells;
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
    tell("accuracy: " + material.name);
    std::vector<Score>& row = scores.emplace_back(jobs.size());
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      jobs[k].score = &row[k];
      if (jobs[k].method == "ours")
        row[k] = run_ours(material, jobs[k].budget);
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
        tell(fmt::format("accuracy: {}, {}", material->name, method));
        *score = run_baseline(*material, method, budget);
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

std::vector<MeanScore> means_of(const std::vector<std::vector<Score>>& scores) {
  std::vector<MeanScore> means;
  for (const std::vector<Score>& row : scores)
    for (Score s : row) {
      const auto known = std::ranges::find_if(means, [&](const MeanScore& mean) {
        return mean.score.method == s.method && mean.score.budget == s.budget;
      });
      if (known == means.end()) {
        means.push_back({std::move(s), 1});
        continue;
      }
      Score& sum = known->score;
      sum.bytes += s.bytes;
      sum.seconds += s.seconds;
      const auto to = figures(sum.errors), from = figures(s.errors);
      for (std::size_t k = 0; k < to.size(); ++k) *to[k] += *from[k];
      if (sum.cost && s.cost) {
        sum.cost->table_reads += s.cost->table_reads;
        sum.cost->multiplies += s.cost->multiplies;
      }
      ++known->materials;
    }
  for (auto& [sum, materials] : means) {
    const auto whole = static_cast<std::size_t>(materials);
    sum.bytes /= whole;
    sum.seconds /= materials;
    for (double* figure : figures(sum.errors)) *figure /= materials;
    if (sum.cost) sum.cost = {sum.cost->table_reads / whole, sum.cost->multiplies / whole};
  }
  return means;
}

Table table_of(const std::vector<MeanScore>& means) {
  Table table(with_figures({"method", "materials"}));
  for (const auto& [score, materials] : means)
    table.add(with_figures({score.method, std::to_string(materials)}, score));
  return table;
}

Table table_of(const std::deque<Material>& materials, const std::vector<std::vector<Score>>& scores) {
  Table table(with_figures({"material", "method", "budget"}));
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const Score& score : scores[i])
      table.add(with_figures(
          {materials[i].name, score.method, score.budget > 0 ? std::to_string(score.budget) : ""}, score));
  return table;
}

}  // namespace burnish::reports
