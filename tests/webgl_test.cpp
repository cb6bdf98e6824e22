// SPDX-License-Identifier: Apache-2.0
// These tests run generated GLSL ES in a browser: WebGL2 draws into floats, which are read back.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>
#include <burnish/testing/webgl.h>

namespace burnish {
namespace {

TEST(WebGl, AgreesWithTheDefinitionInEveryVariant) {
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool("chromium")) GTEST_SKIP() << "no chromium";
  const TemporaryFolder folder("webgl");
  const auto worst = run_webgl(kModelCases, 64, folder.path);
  ASSERT_EQ(worst.size(), std::size(kModelCases));
  // The bounds are those of kShaderVariants; half floats may add 2e-3.
  constexpr VariantErrors kMax = {1e-5, 2e-3, 5e-3, 7e-3};
  for (std::size_t i = 0; i < worst.size(); ++i)
    for (std::size_t k = 0; k < kMax.size(); ++k) {
      if (k == 2 && std::isnan(worst[i][k])) continue;  // WebGL2 need not filter floats
      EXPECT_LE(worst[i][k], kMax[k]) << kModelCases[i].name << " variant " << k;
    }
}

}  // namespace
}  // namespace burnish
