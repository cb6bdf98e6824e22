// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/formula/writer.h>

namespace burnish {
namespace {

const Expr a = Expr::input("a"), b = Expr::input("b"), c = Expr::input("c");

std::string text_of(const Expr& expression, const char* name = "glsl") {
  Graph graph;
  const std::size_t root = graph.add(expression);
  const Writer writer(language(name), graph, {root});
  return writer.text() + writer.text(root);
}

OperationCount count_of(const Expr& expression) {
  Graph graph;
  graph.add(expression);
  return graph.count();
}

TEST(Formula, KeepsTheOrderOfOperationsWithFewParentheses) {
  EXPECT_EQ(text_of(a + b + c), "a + b + c");
  EXPECT_EQ(text_of(a + (b + c)), "a + (b + c)");
  EXPECT_EQ(text_of(a - (b - c)), "a - (b - c)");
  EXPECT_EQ(text_of(a * b / c), "a * b / c");
  EXPECT_EQ(text_of(a / (b * c)), "a / (b * c)");
  EXPECT_EQ(text_of((a + b) * c), "(a + b) * c");
  EXPECT_EQ(text_of(mul_add(a, b + c, a - b)), "a * (b + c) + (a - b)");
  EXPECT_EQ(text_of(neg_mul_add(a, b / c, c)), "c - a * (b / c)");
  EXPECT_EQ(text_of(-(a + b) * c), "(-(a + b)) * c");
  EXPECT_EQ(text_of(Expr(-2.0) * a), "(-2.0) * a");
  EXPECT_EQ(text_of(a + if_less(a, b, c, -a)), "a + (a < b ? c : (-a))");
  EXPECT_EQ(text_of(a + if_less(a, b, c, -a), "wgsl"), "a + select(-a, c, a < b)");
}

TEST(Formula, SharesWhatIsTheSame) {
  const Expr once = sqrt(a * b) + sqrt(a * b);
  EXPECT_EQ(text_of(once), "  float t0 = sqrt(a * b);\nt0 + t0");
  EXPECT_EQ(count_of(once), (OperationCount{.multiplies = 1, .adds = 1, .roots = 1}));
  EXPECT_EQ(text_of(sqrt(a * b) + sqrt(b * a)), "sqrt(a * b) + sqrt(b * a)");
}

TEST(Formula, KeepsTheNamesThatFormulasGive) {
  const Expr first = named("den", a + b), second = named("den", first * c);
  EXPECT_EQ(text_of(second), "  float den = a + b;\n  float den2 = den * c;\nden2");
  EXPECT_EQ(text_of(named("a", a + b) * c), "  float a2 = a + b;\na2 * c") << "a is taken";
  EXPECT_EQ(text_of((a + b) * named("sum", a + b)), "  float sum = a + b;\nsum * sum");
}

TEST(Formula, NoTwoLocalsHaveOneName) {
  const Expr x = sqrt(a), y = sqrt(b), z = sqrt(c);
  const Expr first = named("t", x * y + x * z), second = named("t", first * y);
  EXPECT_EQ(text_of(second / z),
            "  float t0 = sqrt(a);\n  float t1 = sqrt(b);\n  float t2 = sqrt(c);\n"
            "  float t = t0 * t1 + t0 * t2;\n  float t3 = t * t1;\nt3 / t2");
}

TEST(Formula, FoldsWhatIsConstant) {
  EXPECT_EQ(text_of(Expr(1.0) * a + Expr(0.0) * b), "a");
  EXPECT_EQ(text_of(a + (Expr(3.0) - 1.0) * 2.0), "a + 4.0");
}

TEST(Formula, WorksOnVectors) {
  const ExprVector wi(Expr::input("wi", ValueType::vector)), wo(Expr::input("wo", ValueType::vector));
  const ExprVector sum = named("sum", wi + wo);
  EXPECT_EQ(text_of(sum.x / sum.z), "  vec3 sum = wi + wo;\nsum.x / sum.z");
  EXPECT_EQ(text_of(sum.x / sum.z, "hlsl"), "  float3 sum = wi + wo;\nsum.x / sum.z");
  EXPECT_EQ(count_of(sum.x / sum.z), (OperationCount{.adds = 3, .divisions = 1}));
  EXPECT_EQ(text_of((wi + mirror(wo)).whole()), "wi + vec3(-wo.x, -wo.y, wo.z)");
}

TEST(Formula, KnowsWhatAValueDependsOn) {
  Graph graph;
  const std::size_t of_b = graph.add(sqrt(b)), of_both = graph.add(a * sqrt(b));
  EXPECT_TRUE(graph.reaches(of_both, "a"));
  EXPECT_FALSE(graph.reaches(of_b, "a"));
  EXPECT_TRUE(graph.reaches(of_b, "b"));
}

TEST(Formula, CountsWhatEachStatementComputes) {
  Graph graph;
  const std::size_t root = graph.add(named("u", a * b + c) / sqrt(a));
  const Writer writer(language("c"), graph, {root});
  ASSERT_EQ(writer.statements().size(), 1u);
  EXPECT_EQ(writer.statements()[0].count, (OperationCount{.multiplies = 1, .adds = 1}));
  EXPECT_EQ(writer.count(root), (OperationCount{.divisions = 1, .roots = 1}));
}

TEST(Formula, WritesNumbersThatAreReadBackToTheSameFloat) {
  for (const double x : {0.1, 1.0 / 3, 1e-30, 65536.0, 1.5, 0.6495190528383290, 3e8})
    EXPECT_EQ(std::stof(language("glsl").literal(x)), static_cast<float>(x)) << x;
  EXPECT_EQ(language("c").literal(2), "2.0f");
  EXPECT_EQ(language("rust").literal(0.1), "0.1f32");
}

TEST(Formula, EveryLanguageSpellsTheArithmetic) {
  const Expr value = max(abs(a), min(floor(b), sqrt(c))) + power(if_less(a, b, a, b), 0.3);
  for (const Language& l : languages()) EXPECT_NE(text_of(value, std::string(l.name).c_str()), "") << l.name;
  EXPECT_THROW(language("basic"), Error);
}

}  // namespace
}  // namespace burnish
