#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace burnish {

/// Rows of a sparse matrix J whose entries lie in pairs: pair p of every row in two neighbours of the same
/// table's unknowns.
struct PairedRows {
  struct Pair {
    std::size_t first, count;  ///< the table's unknowns
    std::size_t stride;        ///< from an unknown to its neighbour
  };
  std::vector<Pair> pairs;
  std::size_t rows = 0;
  std::vector<std::uint32_t> unknown;       ///< [pair][row], the first of the two
  std::vector<std::array<float, 2>> value;  ///< [pair][row]
};

/// Lower triangle of J^T J; what stands above it is meaningless. Tables are disjoint; all
/// unknowns are below n. In double
/// precision, the same for any number of threads.
void find_gram(const PairedRows& j, std::size_t n, Eigen::MatrixXd& gram);

}  // namespace burnish
