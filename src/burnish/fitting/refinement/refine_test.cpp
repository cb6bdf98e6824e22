#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/plans/fit_plan.h>
#include <burnish/fitting/refinement/picture_loss_lanes.h>
#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {
namespace {

TrainingSet small_set(const AnalyticBrdf& brdf, std::size_t count = 3000) {
  return draw_training_set(brdf.ref(), {.pictures = count, .directions = count});
}

// Random logarithms in [-1, 0].
LogModel random_model(const std::string& expression, const std::vector<std::string>& tables, int channels) {
  LogModel model{.spec = parse_model_spec(expression, tables, true), .channels = channels, .log_values = {}};
  Pcg32 random(3);
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t) {
    model.log_values.emplace_back(model.spec.tables[t].layout.node_count() * model.step(t));
    for (double& v : model.log_values.back()) v = -random.uniform();
  }
  return model;
}

std::vector<double> evaluate(const LogModel& model, const TrainingSet& set) {
  const FactoredBrdf brdf = to_brdf(model, TableFormat::single);
  std::vector<double> f(set.size() * static_cast<std::size_t>(model.channels));
  for (std::size_t i = 0; i < set.size(); ++i)
    brdf.eval(set.pairs[i].wi, set.pairs[i].wo,
              std::span(f).subspan(i * static_cast<std::size_t>(model.channels),
                                   static_cast<std::size_t>(model.channels)));
  return f;
}

TEST(TrainingSet, IsPixelsAndPairsAboveTheHorizonAndTheSameForASeed) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2");
  const TrainingSet set = small_set(ggx), again = small_set(ggx);
  EXPECT_EQ(set.pairs, again.pairs);
  EXPECT_EQ(set.picture_count, 3000u);
  EXPECT_GT(set.exposure, 0);
  double pair_weights = 0, rim_weights = 0;
  std::size_t rim = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_GT(set.pairs[i].wi.z, 0);
    EXPECT_GT(set.pairs[i].wo.z, 0);
    EXPECT_NEAR(length(set.pairs[i].wi), 1, 1e-12);
    EXPECT_GT(set.weights[i], 0);
    if (i < set.picture_count) continue;
    const double least = std::min(set.pairs[i].wi.z, set.pairs[i].wo.z);
    EXPECT_GT(least, 0.005);
    (least > 0.05 ? pair_weights : rim_weights) += set.weights[i];
    rim += least <= 0.05;
  }
  EXPECT_EQ(set.size(), 6000 + rim);         // pairs near the horizon come on top
  EXPECT_NEAR(pair_weights / 3000, 1, 0.2);  // but for the pairs that fall below the horizon
  EXPECT_GT(rim, 100u);
  EXPECT_LT(rim_weights, 0.02 * pair_weights);
  const TrainingSet part = thinned(set, 7);
  EXPECT_EQ(part.pairs.front(), set.pairs.front());
  EXPECT_EQ(part.picture_count, (3000u + 6) / 7);
  EXPECT_EQ(part.pairs[part.picture_count], set.pairs[set.picture_count]);
}

TEST(TrainingSet, CrowdsPixelsAtTheHighlightAndWeighsThemAsIfTheyWereEven) {
  const AnalyticBrdf matte = parse_analytic("ggx:alpha_x=0.4,alpha_y=0.4,kd=0.5");
  const auto near_highlight = [](const TrainingSet& set, bool weighted) {
    double near = 0, all = 0;
    for (std::size_t i = 0; i < set.picture_count; ++i) {
      const Vec3 half = normalize(set.pairs[i].wi + set.pairs[i].wo);
      const double weight = weighted ? set.weights[i] : 1;
      all += weight;
      if (half.z > std::cos(0.2)) near += weight;
    }
    return near / all;
  };
  const TrainingSet even = draw_training_set(matte, {.pictures = 40'000, .directions = 10});
  const TrainingSet crowded =
      draw_training_set(matte, {.pictures = 40'000, .directions = 10, .crowded = true});
  EXPECT_GT(near_highlight(crowded, false), 3 * near_highlight(even, false));
  EXPECT_NEAR(near_highlight(crowded, true) / near_highlight(even, true), 1, 0.05);
  for (std::size_t i = 0; i < crowded.picture_count; ++i) {
    EXPECT_GT(crowded.weights[i], 0);
    EXPECT_LE(crowded.weights[i], 2);
  }
  EXPECT_GT(crowded.exposure, even.exposure);  // pixels in the dark count
}

TEST(PictureLoss, SlopeIsTheDerivativeOfTheErrors) {
  const PictureLoss loss{.shares = {1, 1, 1, 1}, .exposure = 2};
  const ErrorTerms ones{1, 1, 1, 1};
  for (const bool picture : {true, false})
    for (const double f : {0.0, 1e-3, 0.2, 0.4})
      for (const double model : {1e-4, 0.05, 0.3, 0.45}) {
        const auto value = [&](double log_model) {
          ErrorTerms sums{};
          loss.add(loss.target(f, 0.8, picture), std::exp(log_model), 0.8, picture, 1, ones, sums);
          return sums[0] + sums[1] + sums[2] + sums[3];
        };
        ErrorTerms sums{};
        const auto slope = loss.add(loss.target(f, 0.8, picture), model, 0.8, picture, 1, ones, sums);
        const double x = std::log(model), h = 1e-4;
        EXPECT_NEAR(slope.gradient, (value(x + h) - value(x - h)) / (2 * h), 1e-5) << f << ' ' << model;
        EXPECT_GE(slope.curvature, 0);
      }
}

TEST(PictureLoss, IsZeroWhereTheModelIsRight) {
  const PictureLoss loss{.exposure = 3};
  for (const bool picture : {true, false}) {
    ErrorTerms sums{};
    const auto slope = loss.add(loss.target(0.1, 0.5, picture), 0.1, 0.5, picture, 1, {1, 1, 1, 1}, sums);
    for (const double s : sums) EXPECT_NEAR(s, 0, 1e-12);
    EXPECT_NEAR(slope.gradient, 0, 1e-4);
  }
}

TEST(PictureLoss, IsTheSameInLanes) {
  constexpr std::size_t kCount = 256;
  const PictureLoss loss{.exposure = 2};
  const ErrorTerms derivatives{3, 1, 0.5, 2};
  Pcg32 random(4);
  std::vector<float> first(kCount), second(kCount), model(kCount), cosine(kCount), pixels(kCount),
      pairs(kCount), gradient(kCount), curvature(kCount);
  ErrorTerms expected{}, sums{};
  std::vector<PictureLoss::Slope> slopes;
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool picture = i < kCount / 2 + 3;  // within a vector
    const double f = i % 7 == 0 ? 0 : 2 * random.uniform();
    cosine[i] = static_cast<float>(random.uniform());
    model[i] = static_cast<float>(i % 5 == 0 ? 1e-6 : f * std::exp(random.uniform() - 0.5) + 1e-3);
    (picture ? pixels : pairs)[i] = static_cast<float>(random.uniform());
    const PictureLoss::Target target = loss.target(f, cosine[i], picture);
    first[i] = target.first;
    second[i] = target.second;
    slopes.push_back(
        loss.add(target, model[i], cosine[i], picture, pixels[i] + pairs[i], derivatives, expected));
  }
  add_losses(loss,
             {.first = first.data(),
              .second = second.data(),
              .model = model.data(),
              .cos_theta_i = cosine.data(),
              .picture_weight = pixels.data(),
              .pair_weight = pairs.data()},
             kCount, derivatives, sums, gradient.data(), curvature.data());
  for (std::size_t k = 0; k < kErrorTerms; ++k) EXPECT_NEAR(sums[k], expected[k], 1e-5 * expected[k]);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(gradient[i], slopes[i].gradient, 1e-5 * (1 + std::abs(slopes[i].gradient))) << i;
    EXPECT_NEAR(curvature[i], slopes[i].curvature, 1e-4 * slopes[i].curvature) << i;
  }
}

TEST(RefineSystem, MatrixAndRowsAreTheSameSystem) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2");
  const TrainingSet set = small_set(ggx, 500);
  const std::string different = "p(wo) p(wi) q(h) + q(h) g(theta_d,theta_m)";
  // tables of one layout, more of them than a vector has lanes
  const std::string alike = "p(wo) p(wi) q(h) g(theta_d,theta_m) + a(wo) b(h) c(theta_d,theta_m)",
                    many = "a(h) b(h) + c(h) d(wo) + e(h) f(h) + g(h) i(h) + j(h) k(h)";
  const struct {
    std::string expression;
    std::vector<std::string> tables;
    std::size_t unknowns;
  } cases[] = {
      {different, {"p=5", "q=9", "g=4x3"}, 5 + 9 + 12},
      {different, {"p=5,shared", "q=9", "g=4x3"}, 5 + 3 * 9 + 3 * 12},
      {alike, {"p=5", "a=5", "q=5", "b=5", "g=4x3", "c=4x3"}, 4 * 5 + 2 * 12},
      {alike, {"p=5,shared", "a=5", "q=5", "b=5", "g=4x3,shared", "c=4x3"}, 5 + 3 * 15 + 12 + 3 * 12},
      {many, {"a=5", "b=5", "c=5", "d=5", "e=5", "f=5", "g=5", "i=5", "j=5", "k=5"}, 50}};
  for (const auto& [expression, tables, unknowns] : cases) {
    const LogModel model = random_model(expression.c_str(), tables, 3);
    const bool shared = model.any_shared();
    const Lookups lookups = find_lookups(model.spec, set);
    const PictureLoss loss{.exposure = 0.1};  // no pixel is white
    const RefineSystem system(model, set, lookups, loss, TableFormat::half, shared ? 0 : 1, shared ? 3 : 2);
    const Eigen::VectorXd x = system.read(model);
    ASSERT_EQ(static_cast<std::size_t>(x.size()), unknowns);
    const ErrorTerms means = system.errors(x);
    RefineSystem::Normal normal;
    system.find_normal(x, means, normal);
    const Eigen::MatrixXd matrix = normal.matrix.selfadjointView<Eigen::Lower>();
    const RefineSystem::Rows rows = system.rows(x, means);
    const double size = matrix.norm();
    EXPECT_LT((rows.gradient - normal.gradient).norm(), 1e-5 * normal.gradient.norm());
    Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(x.size(), -1, 1);
    EXPECT_LT((system.apply(rows, v) - matrix * v).norm(), 1e-5 * size * v.norm());
    Eigen::MatrixXd roughness = Eigen::MatrixXd::Zero(x.size(), x.size());
    system.add_roughness_matrix(1, roughness);
    EXPECT_NEAR(v.dot(roughness * v), system.roughness(v), 1e-9 * system.roughness(v));
    EXPECT_LT((roughness * v - system.roughness_matrix_times(v)).norm(), 1e-9 * roughness.norm() * v.norm());
    EXPECT_LT((roughness.diagonal() - system.roughness_diagonal()).norm(), 1e-9 * roughness.norm());
    // and the gradient is that of the objective
    for (const Eigen::Index k : {Eigen::Index{2}, x.size() - 3}) {
      Eigen::VectorXd up = x, down = x;
      up[k] += 1e-3;
      down[k] -= 1e-3;
      EXPECT_NEAR(normal.gradient[k],
                  (loss.objective(system.errors(up)) - loss.objective(system.errors(down))) / 2e-3,
                  1e-3 * normal.gradient.cwiseAbs().maxCoeff());
    }
  }
}

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

TEST(Cholesky, SolvesAndFactorizesTheInverse) {
  Pcg32 random(5);
  Eigen::MatrixXd root(12, 12);
  for (double& v : root.reshaped()) v = random.uniform() - 0.5;
  const Eigen::MatrixXd matrix = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(12, 12);
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(12, -1, 1), b = x;
  Eigen::MatrixXd used = matrix;
  solve_in_place(used, x);
  EXPECT_LT((matrix * x - b).cwiseAbs().maxCoeff(), 1e-12);
  used = matrix;
  ASSERT_TRUE(factorize_inverse(used));
  const Eigen::MatrixXd upper = used.triangularView<Eigen::Upper>();
  EXPECT_LT((upper.transpose() * upper * matrix - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(),
            1e-10);
  used = -matrix;
  EXPECT_FALSE(factorize_inverse(used));
  used = -matrix;
  solve_in_place(used, x);
  EXPECT_EQ(x.cwiseAbs().maxCoeff(), 0);
}

TEST(ToRoundedBrdf, LosesLessThanRoundingEachValue) {
  const AnalyticBrdf paint = parse_analytic("ggx:alpha_x=0.2,alpha_y=0.2,kd=0.4/0.02/0.1,f0=0.05/0.5/0.9");
  const TrainingSet set = small_set(paint);
  for (const char* p : {"p=9", "p=9,shared"})
    for (const TableFormat format : {TableFormat::rgb9e5, TableFormat::unorm8}) {
      const RefineOptions options{.format = format, .max_iterations = 12};
      const LobesFit fit = fit_lobes(
          set, parse_model_spec("p(wo) p(wi) q(h) r(theta_d)", std::vector<std::string>{p, "q=40"}, true),
          options);
      // what refinement lowers, of what is stored, on directions that were not fitted
      const auto error = [&](const FactoredBrdf& brdf) {
        const ErrorFigures e = error_figures(paint.ref(), brdf, {.count = 20'000, .image_size = 64});
        const ErrorTerms shares = options.shares;
        return shares[0] * std::log(std::pow(10, -e.psnr / 10)) + shares[2] * std::log(e.relative) +
               shares[3] * std::log(e.log_cos);
      };
      const FactoredBrdf good = to_rounded_brdf(fit.model, set, options), plain = to_brdf(fit.model, format);
      EXPECT_EQ(good.bytes(), plain.bytes());
      EXPECT_TRUE(good.reciprocal());
      EXPECT_LT(error(good), error(plain) + 0.01) << to_string(format) << p;
      if (format == TableFormat::unorm8 && std::string(p) == "p=9,shared") {
        EXPECT_LT(error(good), error(plain) - 0.2);
      }
    }
  const LogModel model = random_model("p(wo) p(wi) q(h)", {}, 3);
  EXPECT_EQ(to_rounded_brdf(model, set, {.format = TableFormat::half}), to_brdf(model, TableFormat::half));
}

TEST(Refine, RecoversASumOfTwoLobes) {
  const LogModel truth = random_model("p(wo) p(wi) q(h) + s(h) t(theta_d)", {"p=5", "q=9", "s=5", "t=7"}, 1);
  TrainingSet set = small_set(parse_analytic("lambert"), 4000);
  const std::vector<double> f = evaluate(truth, set);
  set.channels = 1;
  set.values.assign(f.begin(), f.end());
  const LobesFit fit =
      fit_lobes(set, truth.spec, {.smooth = 0, .max_iterations = 100, .least_progress = 1e-6});
  const std::vector<double> g = evaluate(fit.model, set);
  double worst = 0;
  for (std::size_t i = 0; i < f.size(); ++i) worst = std::max(worst, std::abs(std::log(g[i] / f[i])));
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(fit.summary.error_after, fit.summary.error_before);
}

TEST(Refine, DoesNotDependOnTheNumberOfThreads) {
  const TrainingSet set = small_set(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2"), 2000);
  const LobePlan plan = default_plan(600, 2, true, 6);
  const auto fit = [&](int threads) {
    const ThreadLimit limit(threads);
    return fit_plan(set, plan, 600, 6, {.max_iterations = 4}).model.log_values;
  };
  EXPECT_EQ(fit(1), fit(2));
}

TEST(Refine, IteratesWhereTheMatrixWouldBeTooLarge) {
  // 45 x 45 nodes are more than the direct solver takes
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.5,kd=0");
  const TrainingSet set = small_set(ggx, 3000);
  LogModel model = fit_one_lobe(parse_model_spec("pqp", std::vector<std::string>{"p=5x5", "q=45x45"}, false),
                                set, set.values, 1e-6);
  const FitSummary summary = refine(model, set, {.smooth = 1e-8, .max_iterations = 3});
  EXPECT_LT(summary.error_after, summary.error_before - 0.2);
}

TEST(Refine, RefusesBadOptions) {
  const TrainingSet set = small_set(parse_analytic("lambert"), 100);
  LogModel model = random_model("pqp", {}, 3);
  EXPECT_THROW(refine(model, set, {.smooth = -1}), Error);
  EXPECT_THROW(refine(model, set, {.max_iterations = -1}), Error);
  LogModel grey = random_model("pqp", {}, 1);
  EXPECT_THROW(refine(grey, set, {}), Error);
}

}  // namespace
}  // namespace burnish
