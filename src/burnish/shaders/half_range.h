#pragma once

#include <cstddef>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Exponents e, one a table: textures hold its values times 2^e, so that what is left of each lobe's scale comes near 1
/// and products of tables stay within the range of half floats. In [0, 15], where no format loses a bit; 0 of
/// unorm8.
std::vector<int> table_exponents(const FactoredBrdf& brdf);

/// What a lobe's product is multiplied with before each of its steps, as exponents of 2 that add up to 0: a step
/// is a pair of factors or one factor, of values times their tables' `exponents`. All are 0 where the products
/// that some thousand pairs of directions have stay within half floats as they are.
std::vector<int> step_exponents(const FactoredBrdf& brdf, std::size_t lobe,
                                const std::vector<int>& exponents);

}  // namespace burnish
