#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include <burnish/fitting/choosing/trial_sets.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TrainingSet whole_set() {
  return draw_training_set(fixtures::Glossy{}, {.pictures = 500, .directions = 800});
}

TEST(TrialSets, AreAnEighthEachAndHaveNoPairInCommon) {
  const TrainingSet set = whole_set();
  const TrialSets trials(set);
  std::set<std::pair<double, double>> seen;
  for (const TrainingSet* part : {&trials.fitted, &trials.judged}) {
    EXPECT_NEAR(static_cast<double>(part->size()), static_cast<double>(set.size()) / 8, 2);
    EXPECT_NEAR(static_cast<double>(part->picture_count), static_cast<double>(set.picture_count) / 8, 1);
    for (const DirectionPair& pair : part->pairs) EXPECT_TRUE(seen.insert({pair.wi.x, pair.wo.y}).second);
  }
}

TEST(TrialSets, PartsKeepWhatBelongsToAPair) {
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
    // weights are those of the pairs, to a factor of each kind
    const std::size_t first = k < part.picture_count ? 0 : part.picture_count,
                      from = k < part.picture_count ? 3 : set.picture_count + 3;
    EXPECT_FLOAT_EQ(part.weights[k] * set.weights[from], part.weights[first] * set.weights[i]);
  }
}

TEST(TrialSets, GreyIsTheMeanOfTheChannels) {
  const TrainingSet set = whole_set(), grey = mean_of_channels(set);
  ASSERT_EQ(grey.channels, 1u);
  ASSERT_EQ(grey.values.size(), set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    EXPECT_FLOAT_EQ(3 * grey.values[i], set.values[3 * i] + set.values[3 * i + 1] + set.values[3 * i + 2]);
}

TEST(TrialSets, TrialsAreEachMadeOnceAndToldWithinTheirPart) {
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
  for_each_trial(made.size(), options, 0.25, 0.75, [&](std::size_t k) { ++made[k]; });
  for (const auto& times : made) EXPECT_EQ(times, 1);
  EXPECT_GT(last, 0.25);
  const RefineOptions few = in_few_steps(options, 3);
  EXPECT_FALSE(few.progress);
  EXPECT_EQ(few.max_iterations, 3);
  EXPECT_EQ(few.format, TableFormat::single);
}

}  // namespace
}  // namespace burnish
