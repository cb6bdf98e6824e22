// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/testing/log_models.h>

namespace burnish {
namespace {

using fixtures::evaluate;
using fixtures::random_model;
using fixtures::small_set;

TEST(LogModel, SplittingALobeChangesNothing) {
  for (const char* expression : {"p(wo) p(wi) q(h) r(theta_d)", "p(wo) p(wi) q(h)"}) {
    const TrainingSet set = small_set(parse_analytic("lambert"), 300);
    const LogModel model = random_model(expression, {}, 3);
    const LogModel split = with_lobe_split(model, 0, 0.4, "x");
    ASSERT_EQ(split.spec.lobes.size(), 2u);
    const std::vector<double> a = evaluate(model, set), b = evaluate(split, set);
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b[i], a[i], 1e-5 * a[i]) << expression;
  }
}

TEST(LogModel, ResamplingToMoreNodesKeepsTheFunctions) {
  const TrainingSet set = small_set(parse_analytic("lambert"), 300);
  const std::vector<std::string> few{"p=5", "q=9", "g=4x3"}, more{"p=9", "q=17", "g=7x5"};
  const char* expression = "p(wo) p(wi) q(h) g(theta_d,theta_m)";
  const LogModel model = random_model(expression, few, 3);
  const LogModel fine = resampled(model, parse_model_spec(expression, more, true));
  const std::vector<double> a = evaluate(model, set), b = evaluate(fine, set);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b[i], a[i], 1e-5 * a[i]);
  // a table that was not there is 1
  const LogModel added =
      resampled(model, parse_model_spec("p(wo) p(wi) q(h) g(theta_d,theta_m) s(h)", few, true));
  const std::vector<double> c = evaluate(added, set);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(c[i], a[i], 1e-5 * a[i]);
}

TEST(LogModel, SplittingKeepsCommonTables) {
  const TrainingSet set = small_set(parse_analytic("lambert"), 300);
  const std::vector<std::string> common{"p"};
  for (const char* expression : {"p(wo) p(wi) q(h) r(theta_d)", "p(wo) p(wi) q(h)"}) {
    const LogModel model = random_model(expression, {}, 3);
    const LogModel split = with_lobe_split(model, 0, 0.4, "x", common);
    EXPECT_EQ(split.spec.tables.size(), 2 * model.spec.tables.size() - 1);
    const std::vector<double> a = evaluate(model, set), b = evaluate(split, set);
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b[i], a[i], 1e-5 * a[i]) << expression;
  }
}

TEST(LogModel, ResamplingToSharedTablesKeepsWhatTheyCanHold) {
  const TrainingSet set = small_set(parse_analytic("lambert"), 300);
  LogModel model = random_model("p1(wo) p1(wi) q1(h) + p2(wo) p2(wi) q2(h)",
                                std::vector<std::string>{"p1=5", "q1=9", "p2=5", "q2=9"}, 3);
  // p of both lobes the same, and grey up to a colour
  const double colour[] = {0.3, -0.2, -0.1};
  for (std::size_t i = 0; i < model.log_values[0].size(); ++i)
    model.log_values[2][i] = model.log_values[0][i] = -0.1 * static_cast<double>(i / 3) + colour[i % 3];
  const LogModel shared =
      resampled(model, parse_model_spec("p(wo) p(wi) q1(h) + p(wo) p(wi) q2(h)",
                                        std::vector<std::string>{"p=5,shared", "q1=9", "q2=9"}, true));
  EXPECT_EQ(shared.step(0), 1u);
  const std::vector<double> a = evaluate(model, set), b = evaluate(shared, set);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b[i], a[i], 1e-5 * a[i]);
}

}  // namespace
}  // namespace burnish
