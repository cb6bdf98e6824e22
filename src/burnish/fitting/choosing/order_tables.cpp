// SPDX-License-Identifier: Apache-2.0
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

namespace {

constexpr std::size_t kPairs = 4000;
constexpr double kMinError = 0.01;  // instruments repeat no better

}  // namespace

bool order_matters(BrdfRef source) {
  return source.isotropic() && !source.reciprocal() && reciprocity_error(source, kPairs, 1).mean > kMinError;
}

}  // namespace burnish
