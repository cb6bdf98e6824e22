// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_evaluator.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

class GlEvaluatorTest : public testing::TestWithParam<ModelCase> {
 protected:
  static void SetUpTestSuite() { context_ = std::make_unique<TestContext>(); }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_->context) GTEST_SKIP() << context_->reason;
  }

  static double error(ShaderFilter filter, TableFormat precision) {
    const FactoredBrdf brdf = smooth_model(GetParam());
    return error(brdf, GlEvaluator(brdf, filter, precision));
  }

  static double most_filtered(const FactoredBrdf& brdf) {
    return 5e-3 + filter_error(*context_->context, brdf);
  }

  // The largest relative error over the pairs, divided by how much projections cancel.
  template <class Evaluator>
  static double error(const FactoredBrdf& brdf, const Evaluator& evaluator) {
    const auto pairs = corner_and_random_pairs(5000);
    std::vector<GlVectors> directions;
    for (const auto& [a, b] : pairs) {
      const auto single = [](double x) { return static_cast<float>(x); };
      directions.push_back(
          {{single(a.x), single(a.y), single(a.z)}, {single(b.x), single(b.y), single(b.z)}});
    }
    const std::vector<float> found = evaluator.eval(directions);
    double worst = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& [wi, wo] = pairs[i];
      double f[3];
      brdf.eval(wi, wo, std::span(f).first(brdf.channels()));
      for (std::size_t c = 0; c < 3; ++c) {
        const double truth = f[brdf.channels() == 1 ? 0 : c];
        if (truth > 0)
          worst = std::max(worst, std::abs(found[3 * i + c] / truth - 1) / shader_cancellation(brdf, wi, wo));
        else
          EXPECT_EQ(found[3 * i + c], 0) << "below the horizon";
      }
    }
    return worst;
  }

 private:
  static inline std::unique_ptr<TestContext> context_;
};

TEST_P(GlEvaluatorTest, StaysWithinTheErrorOfEveryFilterAndPrecision) {
  const double filtered = most_filtered(smooth_model(GetParam()));
  EXPECT_LE(error(ShaderFilter::exact, TableFormat::single), 1e-5);
  EXPECT_LE(error(ShaderFilter::hardware, TableFormat::single), filtered);
  EXPECT_LE(error(ShaderFilter::exact, TableFormat::half), 2e-3);
  EXPECT_LE(error(ShaderFilter::hardware, TableFormat::half), filtered + 2e-3);
}

// Shaders whose textures are arguments, 3-D ones as pictures of their layers.
struct ArgumentsEvaluator {
  GlFunction function;

  static std::string call_of(const Shader& shader) {
    std::string uniforms, arguments;
    for (const ShaderTexture& texture : shader.textures) {
      uniforms += fmt::format("uniform sampler2D given_{};\n", texture.name);
      arguments += fmt::format(", given_{}", texture.name);
    }
    return fmt::format("{}{}vec3 call(vec3 wi, vec3 wo) {{ return burnish_model(wi, wo{}); }}\n", shader.text,
                       uniforms, arguments);
  }

  explicit ArgumentsEvaluator(const Shader& shader, bool filtered) : function(call_of(shader), "call") {
    for (const ShaderTexture& texture : shader.textures) {
      GlTexture picture = upload_of(texture, TableFormat::single, filtered);
      picture.name = "given_" + picture.name;
      picture.height *= std::max(picture.depth, 1);
      picture.depth = 0;
      function.set_texture(picture);
    }
  }
  std::vector<float> eval(std::span<const GlVectors> pairs) const { return function.call(pairs); }
};

TEST_P(GlEvaluatorTest, ReadsTexturesThatAreArguments) {
  const FactoredBrdf brdf = smooth_model(GetParam());
  for (const auto& [filter, most] :
       {std::pair{ShaderFilter::exact, 1e-5}, {ShaderFilter::hardware, most_filtered(brdf)}}) {
    const Shader shader =
        generate_shader(brdf, {.filter = filter, .name = "model", .textures_are_arguments = true});
    EXPECT_LE(error(brdf, ArgumentsEvaluator(shader, filter == ShaderFilter::hardware)), most);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, GlEvaluatorTest, testing::ValuesIn(kModelCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(GlEvaluator, RefusesTexturesThatAreNoFloats) {
  EXPECT_THROW(GlEvaluator(smooth_model(model_case("Pqp")), ShaderFilter::exact, TableFormat::unorm8), Error);
}

}  // namespace
}  // namespace burnish
