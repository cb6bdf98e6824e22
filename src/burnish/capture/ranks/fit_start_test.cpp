// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/capture/ranks/fit_start.h>
#include <burnish/testing/checkpoints.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

LobesCheckpoint some_round() {
  return {.key = 6,
          .rounds = 2,
          .log_values = {{1.5, -2}, {3}},
          .fits = {.weights = {0.5f, 0}, .normals = {}, .trust = {1, 0.25f}, .costs = {}},
          .normals_of_all = {0.1f, 0.2f}};
}

TEST(FitStart, IsWhatWasSent) {
  const FitStart weights = parse_start(memory_file(format_start({.step = FitStep::weights})));
  EXPECT_EQ(weights.step, FitStep::weights);
  EXPECT_FALSE(weights.begun.has_value());
  const FitStart first = parse_start(memory_file(format_start({.step = FitStep::lobes})));
  EXPECT_EQ(first.step, FitStep::lobes);
  EXPECT_FALSE(first.begun.has_value());
  const FitStart later =
      parse_start(memory_file(format_start({.step = FitStep::lobes, .begun = some_round()})));
  EXPECT_EQ(later.step, FitStep::lobes);
  ASSERT_TRUE(later.begun.has_value());
  EXPECT_EQ(format_checkpoint(*later.begun), format_checkpoint(some_round()));
}

TEST(FitStart, OfOtherBytesThrows) {
  const std::string whole = format_start({.step = FitStep::lobes, .begun = some_round()});
  for (const std::string& sent : {std::string(), std::string("weight"), std::string("weights and more"),
                                  std::string("rows"), whole.substr(0, whole.size() - 1), whole + '\0'})
    EXPECT_THROW(parse_start(memory_file(sent)), Error) << sent.size();
  // A checkpoint of rows is a message of its own and is refused here.
  EXPECT_THROW(parse_start(memory_file("lobes" + format_checkpoint(some_checkpoint(true)))), Error);
  EXPECT_THAT(error_of([] { parse_start(memory_file("rows")); }),
              testing::HasSubstr("expected weights or lobes, found another message"));
}

}  // namespace
}  // namespace burnish
