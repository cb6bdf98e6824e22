#include <algorithm>
#include <utility>

#include <burnish/fitting/sparse_gram.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// Adds `scale` times the products of pairs a and b of all rows, a's unknowns being the columns.
template <bool adjacent>
void add_products(const PairedRows& j, std::size_t a, std::size_t b, double scale, std::size_t n,
                  double* gram) noexcept {
  const std::size_t next_column = j.pairs[a].stride * n, next_row = j.pairs[b].stride;
  const std::uint32_t *unknown_a = j.unknown.data() + a * j.rows, *unknown_b = j.unknown.data() + b * j.rows;
  const std::array<float, 2>*value_a = j.value.data() + a * j.rows, *value_b = j.value.data() + b * j.rows;
  for (std::size_t r = 0; r < j.rows; ++r) {
    double* into = gram + unknown_a[r] * n + unknown_b[r];
    if constexpr (adjacent) {
      const Eigen::Vector2d v = Eigen::Map<const Eigen::Vector2f>(value_b[r].data()).cast<double>();
      Eigen::Map<Eigen::Vector2d>(into) += scale * value_a[r][0] * v;
      Eigen::Map<Eigen::Vector2d>(into + next_column) += scale * value_a[r][1] * v;
    } else {
      for (const double v : value_a[r]) {
        into[0] += scale * v * value_b[r][0];
        into[next_row] += scale * v * value_b[r][1];
        into += next_column;
      }
    }
  }
}

}  // namespace

void find_gram(const PairedRows& j, std::size_t n, Eigen::MatrixXd& gram) {
  gram.setZero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  // Products by blocks: two tables' is one, below the diagonal.
  struct Product {
    std::size_t column, row;
  };
  std::vector<Product> products;
  for (std::size_t a = 0; a < j.pairs.size(); ++a)
    for (std::size_t b = a; b < j.pairs.size(); ++b)
      products.push_back(j.pairs[a].first <= j.pairs[b].first ? Product{a, b} : Product{b, a});
  const auto block_of = [&](const Product& p) {
    return std::pair(j.pairs[p.column].first, j.pairs[p.row].first);
  };
  std::ranges::stable_sort(products, {}, block_of);
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < products.size(); ++k)
    if (k == 0 || block_of(products[k]) != block_of(products[k - 1])) starts.push_back(k);
  starts.push_back(products.size());

  for_each_chunk(starts.size() - 1, 1, [&](std::size_t block, std::size_t, std::size_t) {
    for (std::size_t k = starts[block]; k < starts[block + 1]; ++k) {
      const auto [a, b] = products[k];
      const double scale = a == b ? 0.5 : 1;  // a block on the diagonal is added to its transpose
      if (j.pairs[b].stride == 1)
        add_products<true>(j, a, b, scale, n, gram.data());
      else
        add_products<false>(j, a, b, scale, n, gram.data());
    }
    const PairedRows::Pair &column = j.pairs[products[starts[block]].column],
                           &row = j.pairs[products[starts[block]].row];
    if (column.first != row.first) return;
    const auto first = static_cast<Eigen::Index>(column.first),
               last = first + static_cast<Eigen::Index>(column.count);
    for (Eigen::Index c = first; c < last; ++c)
      for (Eigen::Index r = c; r < last; ++r) gram(r, c) += gram(c, r);
  });
}

}  // namespace burnish
