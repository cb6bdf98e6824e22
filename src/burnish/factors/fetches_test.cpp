// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/factors/fetches.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

TEST(FetchCount, CountsWhatLobesShareOnce) {
  const struct {
    const char* model;
    std::size_t fetches, textures;
  } cases[] = {{"p(wo) q(h) p(wi)", 3, 1},
               {"z(theta_h) g(theta_h,theta_d,phi_d)", 2, 2},
               {"g(theta_h,theta_d,phi_d)", 1, 1},
               {"z(theta_h) g(theta_h,theta_d) + z(theta_h) p(wo) p(wi)", 4, 1},
               {"p(wo) q(h) p(wi) + p(wo) s(h) p(wi) + t(theta_d)", 5, 1},
               {"v(wi,wo) + v(wo,wi)", 2, 1}};
  for (const auto& [model, fetches, textures] : cases) {
    EXPECT_EQ(texture_count(random_model(model, {}, 1, TableFormat::half)), textures) << model;
    EXPECT_EQ(fetch_count(random_model(model, {}, 1, TableFormat::half)), fetches) << model;
    EXPECT_EQ(fetch_count(parse_model_spec(model, {}, true)), fetches) << model;
  }
}

}  // namespace
}  // namespace burnish
