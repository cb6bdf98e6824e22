// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/math/parallel.h>

namespace burnish {
namespace {

TEST(Parallel, CoversEveryElementOnce) {
  std::vector<std::atomic<int>> visits(1000);
  for_each_chunk(visits.size(), 7, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    EXPECT_EQ(begin, 7 * chunk);
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  for (const auto& count : visits) EXPECT_EQ(count, 1);
}

TEST(Parallel, RethrowsAndLeavesLoopsWithinOtherChunksWhole) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::atomic<int> halved = 0;
    const auto outer = [&](std::size_t chunk, std::size_t, std::size_t) {
      if (chunk == 1) throw std::runtime_error("ended");
      for (int inner = 0; inner < 50; ++inner) {
        std::atomic<int> done = 0;
        for_each_chunk(64, 1, [&](std::size_t, std::size_t, std::size_t) { ++done; });
        if (done != 64) ++halved;
      }
    };
    EXPECT_THROW(for_each_chunk(2, 1, outer), std::runtime_error);
    EXPECT_EQ(halved, 0);
  }
}

}  // namespace
}  // namespace burnish
