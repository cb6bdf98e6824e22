// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>

#include <burnish/eval/interleaved.h>

namespace burnish {
namespace {

TEST(Interleaved, PlanesHoldTheRowsForEveryCount) {
  for (const std::size_t count : {0, 1, 3, 15, 16, 17, 64, 100}) {
    std::vector<float> rows(3 * count), x(count), y(count), z(count);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<float>(i + 1);
    to_planes(rows.data(), count, x.data(), y.data(), z.data());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(x[i], rows[3 * i]);
      EXPECT_EQ(y[i], rows[3 * i + 1]);
      EXPECT_EQ(z[i], rows[3 * i + 2]);
    }
  }
}

}  // namespace
}  // namespace burnish
