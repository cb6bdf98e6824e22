// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Exponents e, one a table: textures hold its values times 2^e, so that what is left of each lobe's scale comes near 1
/// and products of tables stay within the range of half floats. In [0, 15], where no format loses a bit; 0 of
/// unorm8.
std::vector<int> table_exponents(const FactoredBrdf& brdf);

/// An order of a lobe's factors in which their products stay within half floats, where f_r does, for some
/// thousand pairs of directions.
struct HalfProduct {
  static constexpr int kConstant = -1;

  std::vector<int> order;  ///< numbers of ordered_factors(), or kConstant: the constant 2^exponent
  int exponent = 0;        ///< what the scale has too much for one constant
};
/// Returns the order of a lobe's product, given textures that hold values times 2^exponents, one a table. The product
/// begins with the scale, from which those exponents and the constants' are taken out.
HalfProduct half_product(const FactoredBrdf& brdf, std::size_t lobe, const std::vector<int>& exponents);

}  // namespace burnish
