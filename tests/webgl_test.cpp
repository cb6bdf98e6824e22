// Generated GLSL ES in a browser: WebGL2 draws into floats, which are read back.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/shaders/webgl_for_tests.h>
#include <burnish/tools_for_tests.h>

namespace burnish {
namespace {

TEST(WebGl, AgreesWithTheDefinitionToOnePartIn100000) {
  if (!has_tool("chromium")) GTEST_SKIP() << "no chromium";
  const TemporaryFolder folder("webgl");
  const std::vector<double> worst = run_webgl(kModelCases, 64, folder.path);
  ASSERT_EQ(worst.size(), std::size(kModelCases));
  for (std::size_t i = 0; i < worst.size(); ++i) EXPECT_LE(worst[i], 1e-5) << kModelCases[i].name;
}

}  // namespace
}  // namespace burnish
