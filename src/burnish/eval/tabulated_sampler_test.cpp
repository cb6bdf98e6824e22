// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/eval/visible_half_scalar.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/glossy_models.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

// Views along the normal, at grazing angles, and between.
std::vector<Vec3> views(bool isotropic) {
  std::vector<Vec3> wo;
  for (const double theta_deg : {0.0, 3.0, 25.0, 48.0, 71.0, 86.0, 89.7})
    for (const double phi : {0.4, 2.6})
      if (!isotropic || phi == 2.6) wo.push_back(spherical_direction(radians(theta_deg), phi));
  return wo;
}

Point2 random_point(Pcg32& random) {
  const double x = random.uniform();
  return {x, random.uniform()};
}

// Draws by the definition in double precision; the sampler uses float.
DrawnDirection defined_draw(const TabulatedSampler& sampler, Vec3 wo, Point2 u) {
  const SamplerTables t = sampler.tables();
  SamplerView view;
  static_cast<VisibleHalfMap&>(view) = {t.sharpness, t.share, t.xx, t.xy, t.yy};
  view.thetas = t.thetas;
  view.phis = t.phis;
  view.rows = t.rows;
  view.columns = t.columns;
  view.theta_scale = t.theta_scale;
  view.last_ring = t.thetas - 1;
  view.turn_per_row = (t.isotropic ? 2.0 : 4.0) / t.rows;
  view.per_column = 1.0 / t.columns;
  view.cells = scalar::cells_per_unit(t.rows, t.columns);
  view.row_edges = t.row_edges.data();
  view.cell_edges = t.cell_edges.data();
  const auto d = t.isotropic ? scalar::draw<true, double, std::int32_t>(view, wo.x, wo.y, wo.z, u.x, u.y)
                             : scalar::draw<false, double, std::int32_t>(view, wo.x, wo.y, wo.z, u.x, u.y);
  return {{d.x, d.y, d.z}, d.pdf};
}

// A model and its sampler, made once for all tests.
struct Prepared {
  FactoredBrdf brdf;
  TabulatedSampler sampler;
  std::vector<Vec3> wos;

  explicit Prepared(const ModelCase& model)
      : brdf(glossy_model(model)), sampler(brdf), wos(views(brdf.isotropic())) {}
};

class TabulatedSamplerTest : public ::testing::TestWithParam<ModelCase> {
 protected:
  static const Prepared& prepared() {
    static std::map<std::string, Prepared> all;
    return all.try_emplace(GetParam().name, GetParam()).first->second;
  }
  const FactoredBrdf& brdf = prepared().brdf;
  const TabulatedSampler& sampler = prepared().sampler;
  const std::vector<Vec3>& wos = prepared().wos;
};

TEST_P(TabulatedSamplerTest, DrawsByItsDensity) {
  // Among all draws of the suite, one in a hundred may be worse than this.
  const int tests = static_cast<int>(std::size(kGlossyModels) * views(false).size());
  for (const Vec3 wo : wos) {
    const DrawTest test = test_draws(sampler, wo, 20'000, 3);
    EXPECT_GT(test.p_value, level_of_each(0.01, tests)) << degrees(theta_of(wo));
    EXPECT_NEAR(test.integral, 1, 4e-3) << degrees(theta_of(wo));
  }
}

// A small square of u becomes a solid angle; times the density, this is the square's area.
TEST_P(TabulatedSamplerTest, JacobianOfTheDrawIsTheDensity) {
  Pcg32 random(4);
  int at_borders = 0, count = 0;
  for (const Vec3 wo : wos)
    for (int i = 0; i < 200; ++i, ++count) {
      const double e = 1e-7;
      Point2 u = random_point(random);
      u = {e + (1 - 3 * e) * u.x, e + (1 - 3 * e) * u.y};
      const DrawnDirection drawn = defined_draw(sampler, wo, u);
      const auto at = [&](double x, double y) { return defined_draw(sampler, wo, {x, y}).wi; };
      const Vec3 along_x = at(u.x + e, u.y) - at(u.x - e, u.y);
      const Vec3 along_y = at(u.x, u.y + e) - at(u.x, u.y - e);
      const double area = length(cross(along_x, along_y)) / (4 * e * e);
      at_borders += std::abs(area * drawn.pdf - 1) > 1e-3;
    }
  EXPECT_LE(at_borders, count / 200);
}

TEST_P(TabulatedSamplerTest, TellsTheDensityThatPdfGives) {
  Pcg32 random(5);
  int at_borders = 0, count = 0;
  for (const Vec3 wo : wos)
    for (int i = 0; i < 500; ++i, ++count) {
      const DrawnDirection drawn = sampler.sample_wi(wo, random_point(random));
      EXPECT_NEAR(length(drawn.wi), 1, 2e-6);
      EXPECT_GT(drawn.wi.z, -2e-6);
      at_borders += std::abs(sampler.pdf(drawn.wi, wo) / drawn.pdf - 1) > 1e-3;
    }
  EXPECT_LE(at_borders, count / 200);
}

TEST_P(TabulatedSamplerTest, DrawsInFloatWhatIsDefined) {
  Pcg32 random(11);
  int at_borders = 0, count = 0;
  for (const Vec3 wo : wos)
    for (int i = 0; i < 500; ++i, ++count) {
      const Point2 u = random_point(random);
      const DrawnDirection drawn = sampler.sample_wi(wo, u), expected = defined_draw(sampler, wo, u);
      EXPECT_LT(length(drawn.wi - expected.wi), 1e-4);
      at_borders += std::abs(drawn.pdf / expected.pdf - 1) > 1e-3;
    }
  EXPECT_LE(at_borders, count / 200);
}

// No draw is wasted. Weights have their mean and a bound, also at grazing wo.
TEST_P(TabulatedSamplerTest, WeightsAreBoundedWithTheAlbedoAsTheirMean) {
  std::vector<double> f(brdf.channels());
  Pcg32 random(6);
  for (const Vec3 wo : wos) {
    double albedo = 0;
    for (const auto& [wi, weight] : half_vector_quadrature(wo, 64, 256))
      albedo += reflected_size(brdf, wi, wo, f) * weight;
    constexpr int kDraws = 4000;
    double sum = 0, squares = 0, most = 0;
    for (int i = 0; i < kDraws; ++i) {
      const DrawnDirection drawn = sampler.sample_wi(wo, random_point(random));
      const double weight = drawn.pdf > 0 ? reflected_size(brdf, drawn.wi, wo, f) / drawn.pdf : 0;
      sum += weight / kDraws;
      squares += weight * weight / kDraws;
      most = std::max(most, weight);
    }
    const double deviation = std::sqrt((squares - sum * sum) / kDraws);
    EXPECT_NEAR(sum, albedo, 5 * deviation + 2e-3 * albedo) << degrees(theta_of(wo));
    EXPECT_LT(squares, 1.5 * sum * sum) << degrees(theta_of(wo));
    EXPECT_LT(most, 8 * albedo) << degrees(theta_of(wo));
  }
}

TEST_P(TabulatedSamplerTest, ManyAtOnceAreWhatOneIs) {
  Pcg32 random(7);
  for (const std::size_t count : {0, 1, 3, 16, 17, 1000}) {
    std::vector<float> in[5], out[4], pdf(count);
    for (auto& o : out) o.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 wo =
          i % 3 ? spherical_direction(std::acos(1 - 0.999 * random.uniform()), random.uniform() * kTwoPi)
                : wos[i % wos.size()];
      const Point2 u = random_point(random);
      const double values[] = {wo.x, wo.y, wo.z, std::min(u.x, 0.9999999), std::min(u.y, 0.9999999)};
      for (int k = 0; k < 5; ++k) in[k].push_back(static_cast<float>(values[k]));
    }
    sampler.sample_wi(DrawSpans{in[0], in[1], in[2], in[3], in[4]},
                      DrawnSpans{out[0], out[1], out[2], out[3]});
    sampler.pdf(DirectionSpans{out[0], out[1], out[2], in[0], in[1], in[2]}, pdf);
    std::size_t other_draws = 0, other_pdfs = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 wo{in[0][i], in[1][i], in[2][i]}, wi{out[0][i], out[1][i], out[2][i]};
      const DrawnDirection one = sampler.sample_wi(wo, {in[3][i], in[4][i]});
      EXPECT_LT(length(one.wi - wi), 2e-3) << i;
      other_draws += std::abs(out[3][i] - one.pdf) > 3e-3 * one.pdf;
      const double expected = sampler.pdf(wi, wo);
      other_pdfs += std::abs(pdf[i] - expected) > 3e-3 * expected;
    }
    // These draws lie at borders of cells.
    EXPECT_LE(other_draws, count / 100);
    EXPECT_LE(other_pdfs, count / 100);
  }
}

TEST_P(TabulatedSamplerTest, TurnsWithTheMaterial) {
  if (!brdf.isotropic()) GTEST_SKIP() << "anisotropic";
  Pcg32 random(8);
  const double angle = 1.1, c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](Vec3 w) { return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
  for (const Vec3 wo : wos) {
    if (wo.z == 1) continue;  // the normal's azimuth is arbitrary
    for (int i = 0; i < 50; ++i) {
      const Point2 u = random_point(random);
      const DrawnDirection here = sampler.sample_wi(wo, u), there = sampler.sample_wi(turned(wo), u);
      EXPECT_LT(length(turned(here.wi) - there.wi), 1e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, TabulatedSamplerTest, ::testing::ValuesIn(kGlossyModels),
                         [](const auto& model) { return std::string(model.param.name); });

TEST(TabulatedSampler, ServesAnalyticBrdfsOfAnyWidth) {
  for (const char* spec :
       {"lambert", "ggx:alpha_x=0.005,alpha_y=0.005,f0=0.9,kd=0.2", "ward:alpha_x=0.05,alpha_y=0.4"}) {
    const AnalyticBrdf brdf = parse_analytic(spec);
    const TabulatedSampler sampler(brdf.ref());
    std::vector<double> f(3);
    Pcg32 random(9);
    for (const Vec3 wo : views(false)) {
      if (theta_of(wo) > radians(89)) continue;
      double sum = 0, squares = 0;
      for (int i = 0; i < 2000; ++i) {
        const DrawnDirection drawn = sampler.sample_wi(wo, random_point(random));
        const double weight = drawn.pdf > 0 ? reflected_size(brdf.ref(), drawn.wi, wo, f) / drawn.pdf : 0;
        sum += weight / 2000;
        squares += weight * weight / 2000;
      }
      EXPECT_LT(squares, 1.35 * sum * sum) << spec << " " << degrees(theta_of(wo));
    }
  }
}

// Fits are like this where nothing was measured: the reflected light changes its shape within the last degrees.
TEST(TabulatedSampler, FollowsALobeThatRisesAtTheHorizon) {
  const std::vector<std::string> options{"q=32,rational:0.3", "s=30"};
  const ModelSpec spec = parse_model_spec("q(h) + s(wi+0.5wo) s(0.5wi+wo)", options, true);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = 1, .values = {}};
    for (int x = 0; x < t.layout.width; ++x) {
      const double broad = -std::log1p(50 * (1 - node_direction(t.layout, x, 0).z));
      const double rim = -4.0 * std::min(t.layout.width - 1 - x, 3);
      table.values.push_back(static_cast<float>(t.name == "q" ? broad : rim));
    }
    tables.push_back(std::move(table));
  }
  const FactoredBrdf brdf =
      from_log_tables(1, std::move(tables),
                      {{.scale = {0}, .factors = spec.lobes[0]}, {.scale = {6}, .factors = spec.lobes[1]}},
                      TableFormat::single);
  const TabulatedSampler sampler(brdf);
  std::vector<double> f(1);
  Pcg32 random(10);
  // The largest value is 1.08, at 87.5 degrees. It was 1.47 with rings of wo evenly spaced in tan(theta / 2).
  for (const double theta_deg : {80.0, 83.0, 85.0, 86.0, 87.0, 87.5}) {
    const Vec3 wo = spherical_direction(radians(theta_deg), 0.3);
    double sum = 0, squares = 0;
    for (int i = 0; i < 8000; ++i) {
      const DrawnDirection drawn = sampler.sample_wi(wo, random_point(random));
      const double weight = drawn.pdf > 0 ? reflected_size(brdf, drawn.wi, wo, f) / drawn.pdf : 0;
      sum += weight / 8000;
      squares += weight * weight / 8000;
    }
    EXPECT_LT(squares, 1.15 * sum * sum) << theta_deg;
  }
}

TEST(TabulatedSampler, DrawsEvenlyWhereNothingIsReflected) {
  const TabulatedSampler sampler(fixtures::Lambert{.albedo = {0, 0, 0}});
  EXPECT_NEAR(test_draws(sampler, spherical_direction(0.7, 0.3), 1000, 1).integral, 1, 4e-3);
}

// The half vector is the normal, whose azimuth is arbitrary.
TEST(TabulatedSampler, TellsDensitiesOfMirrorDirectionsAtAnyView) {
  std::vector<float> wi[2], wo[2], z, pdf;
  for (const float up : {1.0f, 0.3f, 1e-2f, 1e-4f, 1e-6f})
    for (const float phi : {0.0f, 0.5f, 1.0f, 1.7f}) {
      const float across = std::sqrt(1 - up * up), quarters = phi * static_cast<float>(kPi / 2);
      const float x = phi == 1 ? 0 : across * std::cos(quarters),
                  y = phi == 0 ? 0 : across * std::sin(quarters);
      wo[0].push_back(x);
      wo[1].push_back(y);
      wi[0].push_back(-x);
      wi[1].push_back(-y);
      z.push_back(up);
    }
  pdf.resize(z.size());
  const TabulatedSampler sampler(glossy_model(glossy_case("Disks")));
  sampler.pdf(DirectionSpans{wi[0], wi[1], z, wo[0], wo[1], z}, pdf);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double one = sampler.pdf({wi[0][i], wi[1][i], z[i]}, {wo[0][i], wo[1][i], z[i]});
    EXPECT_GT(one, 0);
    EXPECT_NEAR(pdf[i], one, 3e-3 * one) << z[i];
  }
}

// For unit vectors, densities are never negative and directions have length 1, whatever u is, and not-a-number stays
// not-a-number. For other vectors the functions only have to return.
TEST(TabulatedSampler, SurvivesAnythingInPlaceOfDirections) {
  const auto sane = [](double pdf, std::initializer_list<Vec3> directions) {
    const bool units =
        std::ranges::all_of(directions, [](Vec3 w) { return length(w) == 1 || std::isnan(length(w)); });
    return !units || std::isnan(pdf) || pdf >= 0;
  };
  const auto reflected = [](Vec3 wi, Vec3 wo) {
    return length(wo) != 1 || std::isnan(length(wi)) || std::abs(length(wi) - 1) < 1e-5;
  };
  const double odd[] = {NAN, INFINITY, -INFINITY, 1e30, -1e30, 1e-40, 0, 1, -1};
  std::vector<float> in[5];
  std::vector<float> out[4], pdf;
  for (const char* name : {"Pqp", "Disks"}) {
    const TabulatedSampler sampler(glossy_model(glossy_case(name)));
    for (const double a : odd)
      for (const double b : odd)
        for (const double z : odd) {
          const Vec3 wo{a, b, z}, turned{b, z, a};
          const DrawnDirection drawn = sampler.sample_wi(wo, {b, z});
          EXPECT_TRUE(sane(drawn.pdf, {wo})) << a << " " << b << " " << z << ": " << drawn.pdf;
          EXPECT_TRUE(reflected(drawn.wi, wo)) << a << " " << b << " " << z << ": " << length(drawn.wi);
          EXPECT_TRUE(sane(sampler.pdf(wo, turned), {wo, turned})) << a << " " << b << " " << z;
          const double values[] = {a, b, z, b, z};
          for (int k = 0; k < 5; ++k) in[k].push_back(static_cast<float>(values[k]));
        }
    pdf.resize(in[0].size());
    for (auto& o : out) o.resize(in[0].size());
    sampler.sample_wi(DrawSpans{in[0], in[1], in[2], in[3], in[4]},
                      DrawnSpans{out[0], out[1], out[2], out[3]});
    sampler.pdf(DirectionSpans{in[0], in[1], in[2], in[2], in[0], in[1]}, pdf);
    for (std::size_t i = 0; i < pdf.size(); ++i) {
      const Vec3 wo{in[0][i], in[1][i], in[2][i]}, turned{in[2][i], in[0][i], in[1][i]};
      EXPECT_TRUE(sane(pdf[i], {wo, turned})) << i << ": " << pdf[i];
      EXPECT_TRUE(sane(out[3][i], {wo})) << i << ": " << out[3][i];
      EXPECT_TRUE(reflected({out[0][i], out[1][i], out[2][i]}, wo)) << i;
    }
  }
}

TEST(TabulatedSampler, RefusesSizesThatDoNotFit) {
  const fixtures::Lambert lambert;
  for (const SamplerOptions& bad : {SamplerOptions{1, 1, 16, 16}, SamplerOptions{16, 2, 16, 16},
                                    SamplerOptions{16, 1, 12, 16}, SamplerOptions{16, 1, 16, 4}})
    EXPECT_THROW(TabulatedSampler(lambert, bad), Error);
  EXPECT_THROW(TabulatedSampler(fixtures::Glossy{.a = 1}, SamplerOptions{16, 1, 16, 16}), Error);
  EXPECT_EQ(TabulatedSampler(lambert).bytes(), 2 * (16 * 16 * 17 + 2u));
}

}  // namespace
}  // namespace burnish
