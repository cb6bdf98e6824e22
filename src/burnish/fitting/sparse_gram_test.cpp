#include <gtest/gtest.h>

#include <burnish/fitting/sparse_gram.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

// Two tables, one of three interleaved channels; the first is looked up twice, also at the same unknowns.
TEST(SparseGram, IsTheProductOfTheDenseMatrix) {
  constexpr std::size_t kRows = 300, kUnknowns = 8 + 15;
  Pcg32 random(5);
  PairedRows j{.pairs = {{.first = 8, .count = 15, .stride = 3},
                         {.first = 0, .count = 8, .stride = 1},
                         {.first = 0, .count = 8, .stride = 1}},
               .rows = kRows};
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kRows, kUnknowns);
  for (const PairedRows::Pair& pair : j.pairs)
    for (std::size_t r = 0; r < kRows; ++r) {
      const auto places = static_cast<double>(pair.count - pair.stride);
      const std::size_t u = pair.first + static_cast<std::size_t>(random.uniform() * places);
      const std::array<float, 2> v{static_cast<float>(random.uniform()),
                                   static_cast<float>(random.uniform())};
      j.unknown.push_back(static_cast<std::uint32_t>(u));
      j.value.push_back(v);
      for (std::size_t k = 0; k < 2; ++k)
        dense(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(u + k * pair.stride)) += v[k];
    }
  Eigen::MatrixXd gram = Eigen::MatrixXd::Constant(2, 2, 7);  // of another step
  find_gram(j, kUnknowns, gram);
  const Eigen::MatrixXd expected = dense.transpose() * dense;
  const Eigen::MatrixXd found = gram.selfadjointView<Eigen::Lower>();
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.maxCoeff());
}

}  // namespace
}  // namespace burnish
