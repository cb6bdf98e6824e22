#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/envelope_matrix.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

/// Bands of 5 below the diagonal, the last two rows full; diagonally dominant.
TEST(EnvelopeMatrix, SolvesABandWithABorder) {
  constexpr std::size_t kSize = 40, kBand = 5;
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < kSize; ++i) first.push_back(i + 2 >= kSize || i < kBand ? 0 : i - kBand);
  EnvelopeMatrix matrix(first);
  std::vector<double> full(kSize * kSize), x(kSize), right(kSize);
  Pcg32 random(3);
  for (std::size_t i = 0; i < kSize; ++i) {
    x[i] = random.uniform() - 0.5;
    for (std::size_t j = first[i]; j <= i; ++j)
      full[i * kSize + j] = full[j * kSize + i] = matrix.at(i, j) = i == j ? 40.0 : random.uniform() - 0.5;
  }
  for (std::size_t i = 0; i < kSize; ++i)
    for (std::size_t j = 0; j < kSize; ++j) right[i] += full[i * kSize + j] * x[j];
  matrix.factor();
  matrix.solve(right);
  for (std::size_t i = 0; i < kSize; ++i) EXPECT_NEAR(right[i], x[i], 1e-12);
}

// Each entry is the sum of one order, whatever is computed beside it.
TEST(EnvelopeMatrix, FactorsToTheBitsOfOneEntryAfterAnother) {
  constexpr std::size_t kSize = 70, kBand = 23;
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < kSize; ++i)
    first.push_back(i + 5 >= kSize ? i % 3 : i < kBand ? 0 : i - kBand + i % 2);
  EnvelopeMatrix matrix(first);
  std::vector<std::vector<double>> rows;
  Pcg32 random(5);
  for (std::size_t i = 0; i < kSize; ++i) {
    rows.emplace_back(kSize);
    for (std::size_t j = first[i]; j <= i; ++j)
      rows[i][j] = matrix.at(i, j) = i == j ? 40.0 : random.uniform() - 0.5;
  }
  matrix.factor();
  for (std::size_t i = 0; i < kSize; ++i)
    for (std::size_t j = first[i]; j <= i; ++j) {
      const std::size_t from = std::max(first[i], first[j]), whole = from + (j - from) / 4 * 4;
      std::array<double, 4> sums{};
      for (std::size_t k = from; k < j; ++k) {
        const volatile double product = rows[i][k] * rows[j][k];  // not contracted
        sums[k < whole ? (k - from) % 4 : 0] += product;
      }
      rows[i][j] -= (sums[0] + sums[1]) + (sums[2] + sums[3]);
      rows[i][j] = i == j ? std::sqrt(rows[i][i]) : rows[i][j] / rows[j][j];
      EXPECT_EQ(matrix.at(i, j), rows[i][j]) << i << ", " << j;
    }
}

TEST(EnvelopeMatrix, RefusesWhatIsNotPositiveDefinite) {
  EnvelopeMatrix matrix({0, 0});
  matrix.at(0, 0) = 1;
  matrix.at(1, 0) = 2;
  matrix.at(1, 1) = 1;
  EXPECT_THROW(matrix.factor(), Error);
}

}  // namespace
}  // namespace burnish
