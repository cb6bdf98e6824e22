// SPDX-License-Identifier: Apache-2.0
// The emitted GLSL of the specular family, run on the OpenGL at hand.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/power/code.h>
#include <burnish/render/gl/gl_function.h>
#include <burnish/testing/gl.h>

namespace burnish {
namespace {

TEST(GlPower, EveryMemberAgreesWithItsDefinition) {
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  std::vector<GlVectors> calls;
  for (const float e : {4.0f, 21.5f, 100.0f, 1000.0f})
    for (int i = 0; i <= 256; ++i) {
      const float u = static_cast<float>(i) / 256;  // cosines crowd at 1, where highlights are
      calls.push_back({{1 - u * u, e, 0}, {}});
    }
  const auto methods = power_methods();
  for (std::size_t first = 0; first < methods.size(); first += 3) {  // three a program
    std::string text, results;
    for (std::size_t k = first; k < first + 3; ++k) {
      if (k < methods.size()) text += power_code(methods[k].method, {"glsl", {}, false});
      results += fmt::format("{}{}", results.empty() ? "" : ", ",
                             k < methods.size() ? fmt::format("power_{}(a.x, a.y)", methods[k].name) : "0.0");
    }
    text += fmt::format("vec3 members(vec3 a, vec3 b) {{ return vec3({}); }}\n", results);
    const std::vector<float> found = GlFunction(text, "members").call(calls);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::size_t k = first + i % 3;
      if (k >= methods.size()) continue;
      const double c = calls[i / 3].a[0], e = calls[i / 3].a[1];
      if (e < methods[k].min_exponent()) continue;
      // coefficients are floats that grow with the exponent, and exp2 is the driver's own: 1e-4 of them
      const double size = methods[k].method == PowerMethod::quadratic_raw ? 1 + e * (1 - c) : 1;
      const double rounding = methods[k].cost.transcendentals > 0 ? 0x1p-12 : 1e-4;
      EXPECT_NEAR(found[i], power(methods[k].method, c, e), rounding * size)
          << methods[k].name << " c " << c << " e " << e;
    }
  }
}

}  // namespace
}  // namespace burnish
