// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/testing/checkpoints.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

FitCheckpoint parse_as(const std::string& bytes, int width = kCheckpointWidth) {
  return parse_checkpoint(memory_file(bytes), width);
}

TEST(FitCheckpoint, RestoresAllThatItKeeps) {
  for (const bool normals : {false, true}) {
    const FitCheckpoint kept = some_checkpoint(normals);
    const std::string bytes = format_checkpoint(kept);
    const FitCheckpoint read = parse_as(bytes);
    EXPECT_EQ(read.key, kept.key);
    ASSERT_EQ(read.damaged.size(), kept.damaged.size());
    for (std::size_t i = 0; i < kept.damaged.size(); ++i) {
      EXPECT_EQ(read.damaged[i].file, kept.damaged[i].file);
      EXPECT_EQ(read.damaged[i].why, kept.damaged[i].why);
    }
    EXPECT_EQ(read.missing_pixels, kept.missing_pixels);
    EXPECT_EQ(read.clipped_pixels, kept.clipped_pixels);
    EXPECT_EQ(read.exposure, kept.exposure);
    EXPECT_EQ(read.lobes, kept.lobes);
    EXPECT_EQ(read.scales, kept.scales);
    EXPECT_EQ(read.rows, kept.rows);
    EXPECT_EQ(read.codes, kept.codes);
    EXPECT_EQ(read.normals, kept.normals);
    EXPECT_EQ(read.texels_without_data, kept.texels_without_data);
    ASSERT_EQ(read.errors.size(), kept.errors.size());
    for (std::size_t i = 0; i < kept.errors.size(); ++i) {
      EXPECT_EQ(read.errors[i].seen, kept.errors[i].seen);
      EXPECT_EQ(read.errors[i].all, kept.errors[i].all);
      EXPECT_EQ(read.errors[i].seen_count, kept.errors[i].seen_count);
      EXPECT_EQ(read.errors[i].all_count, kept.errors[i].all_count);
    }
    EXPECT_EQ(format_checkpoint(read), bytes);
  }
}

TEST(FitCheckpoint, EveryTruncatedFileThrows) {
  const std::string bytes = format_checkpoint(some_checkpoint(true));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(parse_as(bytes.substr(0, length)), Error) << length;
  EXPECT_THROW(parse_as(bytes + '\0'), Error);
}

TEST(FitCheckpoint, OfTexelsThatContradictTheWidthThrows) {
  for (const bool normals : {false, true}) {
    const std::string bytes = format_checkpoint(some_checkpoint(normals));
    for (const int width : {1, kCheckpointWidth - 1, kCheckpointWidth + 1, kMaxMapSide})
      EXPECT_THROW(parse_as(bytes, width), Error) << width;
    EXPECT_NO_THROW(parse_as(bytes));
  }
  FitCheckpoint wrong = some_checkpoint(true);
  wrong.normals.pop_back();
  EXPECT_THROW(parse_as(format_checkpoint(wrong)), Error);
  wrong = some_checkpoint(true);
  wrong.texels_without_data = kCheckpointWidth * kCheckpointRows + 1;
  EXPECT_THROW(parse_as(format_checkpoint(wrong)), Error);
  wrong = some_checkpoint(false);
  wrong.scales.pop_back();
  EXPECT_THROW(parse_as(format_checkpoint(wrong)), Error);
}

TEST(FitCheckpoint, IsKnownByItsName) {
  std::string bytes = format_checkpoint(some_checkpoint(false));
  bytes[bytes.find("burnish fit")] = 'B';
  EXPECT_THAT(error_of([&] { parse_as(bytes); }), testing::HasSubstr("expected a checkpoint"));
}

TEST(LobesCheckpoint, RestoresAllThatItKeepsAndNoPartOfIt) {
  const LobesCheckpoint kept{
      .key = 0xfedcba9876543210,
      .rounds = 3,
      .log_values = {{0.1, -2}, {1.0 / 3}},
      .fits = {.weights = {0.5f, 2}, .normals = {}, .trust = {1, 0, 0.25f}, .costs = {}},
      .normals_of_all = {0.5f, -0.5f}};
  const std::string bytes = format_checkpoint(kept);
  const LobesCheckpoint read = parse_lobes_checkpoint(memory_file(bytes)).value();
  EXPECT_EQ(read.key, kept.key);
  EXPECT_EQ(read.rounds, kept.rounds);
  EXPECT_EQ(read.log_values, kept.log_values);
  EXPECT_EQ(read.fits.weights, kept.fits.weights);
  EXPECT_EQ(read.fits.normals, kept.fits.normals);
  EXPECT_EQ(read.fits.trust, kept.fits.trust);
  EXPECT_EQ(read.normals_of_all, kept.normals_of_all);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(parse_lobes_checkpoint(memory_file(bytes.substr(0, size))), Error) << size;
  EXPECT_FALSE(parse_lobes_checkpoint(memory_file(format_checkpoint(some_checkpoint(true)))).has_value());
  EXPECT_THROW(parse_as(bytes), Error);
}

}  // namespace
}  // namespace burnish
