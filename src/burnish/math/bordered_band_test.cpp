#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/bordered_band.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

struct Shape {
  std::size_t count, band, border;

  std::size_t size() const { return count + border; }
  bool holds(std::size_t row, std::size_t column) const { return row >= count || row - column <= band; }
};
// Sides that no tile divides, bands of a diagonal alone and wider than the matrix, no border and a border alone.
constexpr Shape kShapes[] = {{40, 5, 2},    {70, 23, 5}, {33, 0, 3},   {50, 17, 0}, {3, 9, 2},
                             {101, 40, 33}, {0, 0, 7},   {64, 16, 16}, {1, 0, 0}};

/// A matrix and its lower triangle, [row][column]; diagonally dominant.
struct Example {
  BorderedBand matrix;
  std::vector<std::vector<double>> rows;

  explicit Example(const Shape& shape) : matrix(shape.count, shape.band, shape.border) {
    Pcg32 random(5);
    for (std::size_t i = 0; i < shape.size(); ++i) {
      rows.emplace_back(shape.size());
      for (std::size_t j = 0; j <= i; ++j)
        if (shape.holds(i, j))
          rows[i][j] = matrix.at(i, j) =
              i == j ? 2.0 * static_cast<double>(shape.size()) : random.uniform() - 0.5;
    }
  }
};

TEST(BorderedBand, Solves) {
  for (const Shape& shape : kShapes) {
    auto [matrix, rows] = Example(shape);
    ASSERT_EQ(matrix.size(), shape.size());
    std::vector<double> x(shape.size()), right(shape.size());
    Pcg32 random(3);
    for (double& value : x) value = random.uniform() - 0.5;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < x.size(); ++j) right[i] += rows[std::max(i, j)][std::min(i, j)] * x[j];
    matrix.factor();
    matrix.solve(right);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(right[i], x[i], 1e-13) << shape.count << ", " << i;
  }
}

// Each entry is one product subtracted after another, whatever is computed beside it.
TEST(BorderedBand, FactorsToTheBitsOfOneEntryAfterAnother) {
  for (const Shape& shape : kShapes) {
    auto [matrix, rows] = Example(shape);
    matrix.factor();
    for (std::size_t j = 0; j < shape.size(); ++j) {
      double factor = 0;
      for (std::size_t i = j; i < shape.size(); ++i) {
        if (!shape.holds(i, j)) continue;
        double entry = rows[i][j];
        for (std::size_t k = 0; k < j; ++k) {
          const volatile double product = rows[i][k] * rows[j][k];  // not contracted
          entry -= product;
        }
        if (i == j) factor = 1 / std::sqrt(entry);
        rows[i][j] = entry * factor;
        EXPECT_EQ(matrix.at(i, j), rows[i][j]) << shape.count << ": " << i << ", " << j;
      }
    }
  }
}

TEST(BorderedBand, RefusesWhatIsNotPositiveDefinite) {
  for (const Shape& shape : {Shape{2, 1, 0}, Shape{1, 0, 1}, Shape{0, 0, 2}}) {
    BorderedBand matrix(shape.count, shape.band, shape.border);
    matrix.at(0, 0) = 1;
    matrix.at(1, 0) = 2;
    matrix.at(1, 1) = 1;
    EXPECT_THROW(matrix.factor(), Error);
  }
}

}  // namespace
}  // namespace burnish
