// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TrainingSet whole_set() {
  return draw_training_set(fixtures::Glossy{}, {.pictures = 500, .directions = 800});
}

TEST(Tournament, PartsAreAnEighthEachAndHaveNoPairInCommon) {
  const TrainingSet set = whole_set();
  const TrialParts trials(set, 8);
  std::set<std::pair<double, double>> seen;
  for (const TrainingSet* part : {&trials.fitted, &trials.judged}) {
    EXPECT_NEAR(static_cast<double>(part->size()), static_cast<double>(set.size()) / 8, 2);
    EXPECT_NEAR(static_cast<double>(part->picture_count), static_cast<double>(set.picture_count) / 8, 1);
    for (const DirectionPair& pair : part->pairs) EXPECT_TRUE(seen.insert({pair.wi.x, pair.wo.y}).second);
  }
}

TEST(Tournament, PartsKeepWhatBelongsToAPair) {
  const TrainingSet set = whole_set();
  const TrainingSet part = part_of(set, 3, 5);
  ASSERT_EQ(part.values.size(), part.size() * set.channels);
  ASSERT_EQ(part.weights.size(), part.size());
  for (std::size_t k = 0; k < part.size(); ++k) {
    const std::size_t i =
        k < part.picture_count ? 3 + 5 * k : set.picture_count + 3 + 5 * (k - part.picture_count);
    EXPECT_EQ(part.pairs[k].wi.x, set.pairs[i].wi.x);
    EXPECT_EQ(part.pairs[k].wo.z, set.pairs[i].wo.z);
    for (std::size_t c = 0; c < set.channels; ++c)
      EXPECT_EQ(part.values[k * set.channels + c], set.values[i * set.channels + c]);
    // Weights are those of the pairs, up to one factor for each kind.
    const std::size_t first = k < part.picture_count ? 0 : part.picture_count,
                      from = k < part.picture_count ? 3 : set.picture_count + 3;
    EXPECT_FLOAT_EQ(part.weights[k] * set.weights[from], part.weights[first] * set.weights[i]);
  }
}

TEST(Tournament, GreyIsTheMeanOfTheChannels) {
  const TrainingSet set = whole_set(), grey = mean_of_channels(set);
  ASSERT_EQ(grey.channels, 1u);
  ASSERT_EQ(grey.values.size(), set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    EXPECT_FLOAT_EQ(3 * grey.values[i], set.values[3 * i] + set.values[3 * i + 1] + set.values[3 * i + 2]);
}

TEST(Tournament, TrialsAreEachMadeOnceAndToldWithinTheirPart) {
  const std::thread::id caller = std::this_thread::get_id();
  double last = 0.25;
  RefineOptions options;
  options.progress = [&](double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 0.75);
    last = fraction;
  };
  std::vector<std::atomic<int>> made(20);
  for_each_trial(made.size(), part_of_progress(options.progress, 0.25, 0.75),
                 [&](std::size_t k) { ++made[k]; });
  for (const auto& times : made) EXPECT_EQ(times, 1);
  EXPECT_GT(last, 0.25);
  const RefineOptions few = in_few_steps(options, 3);
  EXPECT_FALSE(few.progress);
  EXPECT_EQ(few.max_iterations, 3);
  EXPECT_EQ(few.format, TableFormat::single);
}

/// Candidates of "q(h)" with 0, 1, ... further tables, each of which adds one read. Their errors are given.
std::vector<Candidate> candidates_of(const std::vector<double>& errors) {
  std::vector<Candidate> candidates;
  std::string model = "q(h)";
  for (const double error : errors) {
    candidates.push_back({.spec = parse_model_spec(model, {}, true), .error = error});
    model += fmt::format(" t{}(theta_d)", candidates.size());
  }
  return candidates;
}

TEST(Tournament, FinalistsAreTheBestAndOfEqualOnesTheFirst) {
  std::vector<Candidate> candidates = candidates_of({3, 1, 2, 1});
  EXPECT_EQ(&winner(candidates), &candidates[1]);
  const std::vector<Candidate> best = finalists(candidates, 3);
  ASSERT_EQ(best.size(), 3u);
  EXPECT_EQ(best[0].spec.tables.size(), 2u);
  EXPECT_EQ(best[1].spec.tables.size(), 4u);
  EXPECT_EQ(best[2].error, 2);
  EXPECT_EQ(finalists(candidates, 9).size(), 4u);
}

TEST(Tournament, HeatsJudgeOnPairsThatNobodyWasFittedToAndCountFetches) {
  const TrainingSet set = mean_of_channels(whole_set());
  const ErrorTerms shares{.relative = 2, .log_cos = 1};
  Heat heat{.parts = TrialParts(set, 4), .options = {}, .shares = shares};
  const auto fit = [&](Candidate& candidate) {
    candidate.fit = fit_lobes(heat.parts.fitted, candidate.spec, in_few_steps(heat.options, 3)).model;
  };
  std::vector<Candidate> free = candidates_of({0, 0});
  std::vector<double> told;
  heat.play(free, fit, [&](double share) { told.push_back(share); });
  for (const Candidate& candidate : free)
    EXPECT_EQ(candidate.error, objective(candidate.fit, heat.parts.judged, shares));
  ASSERT_FALSE(told.empty());
  EXPECT_LE(told.back(), 1);

  std::vector<Candidate> paid = candidates_of({0, 0});
  heat.worth_of_fetch = 0.1;
  heat.play(paid, fit);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(paid[k].error - free[k].error, 0.1 * 3 * static_cast<double>(k + 1), 1e-12);
}

TEST(Tournament, TheKneeIsTheFewestFetchesNearTheLeastError) {
  const ErrorTerms shares{.relative = 1};
  std::vector<Candidate> candidates = candidates_of({std::log(0.2), std::log(0.1005), std::log(0.1)});
  candidates.push_back(candidates[1]);
  candidates.back().error = std::log(0.5);  // the same fetches, but worse
  candidates[2].plan = LobePlan{};
  const FetchTrials tried = best_of_each_fetch_count(candidates, shares);
  ASSERT_EQ(tried.trials.size(), 3u);
  ASSERT_EQ(tried.candidates.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(tried.trials[k].fetches, static_cast<int>(k + 1));
    EXPECT_EQ(tried.trials[k].lobes, k == 2);
    EXPECT_EQ(tried.candidates[k].error, candidates[k].error);
  }
  EXPECT_NEAR(tried.trials[1].error, 0.1005, 1e-12);
  EXPECT_EQ(trial_at_knee(tried.trials).fetches, 2);
}

}  // namespace
}  // namespace burnish
