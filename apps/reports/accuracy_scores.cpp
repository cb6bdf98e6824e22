// SPDX-License-Identifier: Apache-2.0
#include "accuracy_scores.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <future>
#include <thread>

#include <fmt/format.h>

#include <burnish/fitting/fit.h>

#include "report.h"

namespace burnish::reports {

namespace {

Score score_of(const Material& material, std::string_view method, std::size_t budget, BrdfRef model) {
  Score score{
      .method = std::string(method), .budget = budget, .errors = material.scorer.score(model), .picture = {}};
  if (material.shown_budget && budget <= *material.shown_budget)
    score.picture = picture(model, material.scorer.exposure());
  return score;
}

// Returns pointers to the figures of a mean, in a fixed order.
std::array<double*, 6> figures(ErrorFigures& e) {
  return {&e.psnr, &e.ssim, &e.relative, &e.log_cos, &e.rms_log, &e.rms};
}

// Names of our method are "ours", with any number of fetches, and "ours, N fetches", with at most N.
bool is_ours(std::string_view method) {
  return method.starts_with("ours");
}
std::optional<int> fetches_of(std::string_view method) {
  const auto comma = method.find(", ");
  if (comma == method.npos) return {};
  int fetches = 0;
  std::from_chars(method.data() + comma + 2, method.data() + method.size(), fetches);
  return fetches;
}

// Fits and scores our method or a baseline, within so many bytes. With 0 the method takes as many as it needs.
Score run_method(const Material& material, std::string_view method, std::size_t budget) {
  FitOptions options{.target = FitTarget::function, .score = false};
  if (is_ours(method))
    options.form = Budget{.bytes = budget, .fetches = fetches_of(method)};
  else
    options.form = BaselineMethod{.method = std::string(method),
                                  .bytes = budget > 0 ? std::optional<std::uint64_t>(budget) : std::nullopt};
  const Fit made = fit(material.source, options);
  Score score = score_of(material, method, budget, made.ref());
  score.bytes = made.bytes();
  score.cost = std::visit(
      [](const auto& brdf) -> std::optional<EvaluationCost> { return evaluation_cost(brdf); }, made.brdf);
  score.seconds = made.report.seconds;
  if (const auto* lobes = std::get_if<LobesReport>(&made.report.how)) score.fetches = lobes->fetches;
  return score;
}

std::vector<std::string> with_figures(std::vector<std::string> head) {
  for (const char* name : {"bytes", "psnr", "ssim", "relative", "log_cos", "rms_log", "rms", "table reads",
                           "multiplies", "fit seconds"})
    head.emplace_back(name);
  return head;
}

// Says which figures to print in bold, in the order of figures().
using Bold = std::array<bool, 6>;

std::vector<std::string> with_figures(std::vector<std::string> cells, const Score& s, const Bold& bold = {}) {
  const ErrorFigures& e = s.errors;
  cells.push_back(s.bytes > 0 ? std::to_string(s.bytes) : "");
  const std::array texts{fmt::format("{:.2f}", e.psnr),     fmt::format("{:.4f}", e.ssim),
                         fmt::format("{:.4f}", e.relative), fmt::format("{:.4f}", e.log_cos),
                         fmt::format("{:.3f}", e.rms_log),  fmt::format("{:.3g}", e.rms)};
  for (std::size_t k = 0; k < texts.size(); ++k) cells.push_back(bold[k] ? "**" + texts[k] + "**" : texts[k]);
  cells.push_back(s.cost ? std::to_string(s.cost->table_reads) : "");
  cells.push_back(s.cost ? std::to_string(s.cost->multiplies) : "");
  cells.push_back(s.seconds > 0 ? fmt::format("{:.1f}", s.seconds) : "");
  return cells;
}

// Says which figures of one score are better than another's.
Bold ahead_of(Score score, Score other) {
  const auto own = figures(score.errors), others = figures(other.errors);
  Bold ahead;
  for (std::size_t k = 0; k < ahead.size(); ++k) {
    const bool more_is_better = own[k] == &score.errors.psnr || own[k] == &score.errors.ssim;
    ahead[k] = more_is_better ? *own[k] > *others[k] : *own[k] < *others[k];
  }
  return ahead;
}

// Returns the figures of each mean that table_of prints in bold.
std::vector<Bold> bold_figures(const std::vector<MeanScore>& means) {
  std::vector<Bold> bold(means.size(), Bold{});
  for (std::size_t i = 0; i < means.size(); ++i)
    for (std::size_t j = 0; j < means.size(); ++j) {
      const Score &other = means[i].score, &ours = means[j].score;
      if (is_ours(other.method) || other.method == kMeasurement || !is_ours(ours.method) ||
          means[i].materials != means[j].materials ||
          (other.budget > 0 ? other.budget : other.bytes) > ours.budget)
        continue;
      const Bold ahead = ahead_of(other, ours);
      for (std::size_t k = 0; k < ahead.size(); ++k) {
        bold[i][k] |= ahead[k];
        bold[j][k] |= ahead[k];
      }
    }
  return bold;
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
      if (jobs[k].method == "ours") row[k] = run_method(material, jobs[k].method, jobs[k].budget);
    }
    // A fit of "ours" that chose N fetches is also the fit with at most N, and is not repeated.
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      if (jobs[k].method == "ours") continue;
      const std::optional<int> fetches = fetches_of(jobs[k].method);
      const auto same = std::ranges::find_if(row, [&](const Score& score) {
        return fetches == score.fetches && score.budget == jobs[k].budget;
      });
      if (same == row.end()) {
        others.push_back(jobs[k]);
        continue;
      }
      Score copy = *same;
      copy.method = jobs[k].method;
      row[k] = std::move(copy);
    }
  }
  // The other fits run side by side, since each takes one thread most of the time.
  std::atomic<std::size_t> next = 0;
  std::vector<std::future<void>> workers;
  for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t k; (k = next++) < others.size();) {
        const auto& [material, method, budget, score] = others[k];
        tell(fmt::format("accuracy: {}, {}", material->name, method));
        *score = run_method(*material, method, budget);
      }
    }));
  for (std::future<void>& worker : workers) worker.get();
  return scores;
}

Score run_published(const Material& material, std::string_view method, const Source& model) {
  tell(fmt::format("accuracy: {}, {}", material.name, method));
  Score score = score_of(material, method, 0, SymmetrizedBrdf(model.ref()));
  score.bytes = model.bytes().value_or(0);
  std::visit(
      [&](const auto& brdf) {
        if constexpr (requires { evaluation_cost(brdf); }) score.cost = evaluation_cost(brdf);
      },
      model.brdf);
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
  const std::vector<Bold> bold = bold_figures(means);
  for (std::size_t i = 0; i < means.size(); ++i)
    table.add(
        with_figures({means[i].score.method, std::to_string(means[i].materials)}, means[i].score, bold[i]));
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
