// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

TEST(OrderMatters, WhereExchangingTheDirectionsChangesAnIsotropicSource) {
  const fixtures::Ordered source{{.a = 10, .b = 10}};
  EXPECT_TRUE(order_matters(source));
  EXPECT_FALSE(order_matters(SymmetrizedBrdf(source)));
  EXPECT_FALSE(order_matters(fixtures::Ordered{.even = {.a = 10, .b = 10}, .slope = 0.005}));
  EXPECT_FALSE(order_matters(fixtures::Ordered{.even = {.a = 10, .b = 20}}));  // anisotropic
  EXPECT_FALSE(order_matters(parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2,kd=0.1").ref()));
}

}  // namespace
}  // namespace burnish
