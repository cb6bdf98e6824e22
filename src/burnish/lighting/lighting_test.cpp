// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/lighting/area_light_fit.h>
#include <burnish/lighting/area_light_shader.h>
#include <burnish/lighting/area_light_table.h>
#include <burnish/lighting/area_lights.h>
#include <burnish/lighting/rectangle_formula.h>
#include <burnish/lighting/transformed_cosine.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/render/gl/gl_function.h>
#include <burnish/render/gl/gl_objects.h>
#include <burnish/testing/compilers.h>
#include <burnish/testing/gl.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

const TransformedCosine kLobe{{3, 0.4, -0.7, 0.2, 2, 0.5, 0.3, -0.2, 1}};
const std::array<Vec3, 4> kSquare = rectangle_light({0.3, 0.2, 1.5}, {0.6, 0.1, 0}, {-0.1, 0.6, 0.2});

// Small fits, which are good enough for tests.
AreaLightTable small_fit(const AnalyticBrdf& brdf, std::size_t lobes = 2) {
  return fit_area_lights(brdf, {.lobes = lobes, .thetas = 9, .polars = 5, .quarter = 3, .iterations = 15});
}

// Returns the mean over stratified directions of the sphere, times its solid angle.
template <class Value>
double over_sphere(int side, const Value& value) {
  Pcg32 random(1);
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      const double z = 2 * (i + random.uniform()) / side - 1, phi = kTwoPi * (k + random.uniform()) / side;
      const double r = std::sqrt(1 - z * z);
      sum += value(Vec3{r * std::cos(phi), r * std::sin(phi), z});
    }
  return 2 * kTwoPi * sum / (side * side);
}

// True if the ray along w meets a rectangle.
bool meets(const std::array<Vec3, 4>& corners, Vec3 w) {
  const Vec3 u = corners[1] - corners[0], v = corners[3] - corners[0], n = cross(u, v);
  const double t = dot(corners[0], n) / dot(w, n);
  if (!(t > 0)) return false;
  const Vec3 at = t * w - corners[0];
  const double a = dot(at, u) / dot(u, u), b = dot(at, v) / dot(v, v);
  return a >= 0 && a <= 1 && b >= 0 && b <= 1;
}

TEST(TransformedCosine, DensityIntegratesToOneAndItsShareAboveTheHorizonIsExact) {
  EXPECT_NEAR(over_sphere(1000, [](Vec3 w) { return kLobe.density(w); }), 1, 1e-3);
  EXPECT_NEAR(over_sphere(1000, [](Vec3 w) { return w.z > 0 ? kLobe.density(w) : 0; }), kLobe.share_above(),
              1e-3);
  EXPECT_NEAR(TransformedCosine{}.share_above(), 1, 1e-12);
}

TEST(TransformedCosine, ShareOfAPolygonIsTheIntegralOfTheDensity) {
  const std::array low = rectangle_light({1, 0.2, 0.1}, {0, 0.7, 0.1}, {0.05, 0, 0.6});  // across the horizon
  for (const auto& polygon : {rectangle_light({0.3, 0.2, 1.5}, {0.6, 0.2, 0}, {-0.2, 0.6, 0}), low}) {
    const double sampled =
        over_sphere(1500, [&](Vec3 w) { return w.z > 0 && meets(polygon, w) ? kLobe.density(w) : 0; });
    EXPECT_GT(sampled, 0.005);
    EXPECT_NEAR(lobe_share(kLobe, polygon), sampled, 1e-3);
  }
}

TEST(TransformedCosine, HalvesOfARectangleMakeTheWhole) {
  const std::array whole = rectangle_light({1, 0.2, 0.3}, {0, 0.7, 0.1}, {0.05, 0, 0.6});
  const Vec3 low = 0.5 * (whole[0] + whole[1]), high = 0.5 * (whole[3] + whole[2]);
  const std::array<Vec3, 4> left{whole[0], low, high, whole[3]}, right{low, whole[1], whole[2], high};
  EXPECT_NEAR(lobe_share(kLobe, left) + lobe_share(kLobe, right), lobe_share(kLobe, whole), 1e-12);
  EXPECT_GT(lobe_share(kLobe, whole), 1e-3);
}

TEST(TransformedCosine, BehindTheHorizonIsDark) {
  EXPECT_EQ(lobe_share(kLobe, rectangle_light({1, 0, -0.5}, {0, 0.4, 0}, {0.2, 0, 0.3})), 0);
}

TEST(AreaLights, SphereIsSeenAsItsConeAndItsCosineIsKnown) {
  // The irradiance over pi of a sphere in the zenith is sin^2 of its half angle.
  EXPECT_NEAR(cosine_share(sphere_light({0, 0, 2}, 1, 64)), 0.25, 0.25 * 7.0 / (64 * 64));
  EXPECT_NEAR(cosine_share(sphere_light({0, 0, 2}, 1, 16)), 0.25, 0.25 * 7.0 / (16 * 16));
  EXPECT_THROW(sphere_light({0, 0, 1}, 1), Error);
  EXPECT_THROW(disk_light({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 2), Error);
}

TEST(AreaLights, LineIsAThinRectangleThatFacesThePoint) {
  const double thin = cosine_share(line_light({-1, 0, 2}, {1, 0.5, 2}, 0.01));
  EXPECT_NEAR(cosine_share(line_light({-1, 0, 2}, {1, 0.5, 2}, 0.02)), 2 * thin, 1e-3 * thin);
  // The reference is 1/pi times the integral along the line of cos(theta) 2 r sin(to the line) / distance^2.
  double sum = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = (i + 0.5) / 2000;
    const Vec3 at{-1 + 2 * t, 0.5 * t, 2}, along{2, 0.5, 0};
    const double square = dot(at, at);
    sum += at.z / std::sqrt(square) * 0.02 * length(cross(along, at)) / (square * std::sqrt(square)) / 2000 /
           kPi;
  }
  EXPECT_NEAR(thin, sum, 1e-3 * sum);
}

TEST(AreaLightFit, AlbedoAtNodesIsThatOfTheBrdf) {
  if (BURNISH_SANITIZED) GTEST_SKIP() << "fits for minutes";
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.9/0.5/0.2");
  const AreaLightTable table = small_fit(brdf);
  EXPECT_EQ(table.views, AreaLightViews::line);
  for (const std::size_t i : {0u, 3u, 7u}) {
    const Vec3 wo = spherical_direction(2 * std::atan(static_cast<double>(i) / 8), 0.7);
    std::array<double, 3> f{}, sum{};
    for (const auto& [wi, weight] : half_vector_quadrature(wo, 96, 192)) {
      brdf.eval(wi, wo, f);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += f[c] * wi.z * weight;
    }
    const Rgb got = albedo(table, wo);
    EXPECT_NEAR(got.r, sum[0], 1e-4 * sum[0]);
    EXPECT_NEAR(got.g, sum[1], 1e-4 * sum[1]);
    EXPECT_NEAR(got.b, sum[2], 1e-4 * sum[2]);
    // A very large rectangle acts as light from all directions.
    EXPECT_NEAR(reflected(table, rectangle_light({0, 0, 1}, {1e6, 0, 0}, {0, 1e6, 0}), wo).g, got.g,
                1e-4 * got.g);
  }
}

TEST(AreaLightFit, LambertStaysLambert) {
  if (BURNISH_SANITIZED) GTEST_SKIP() << "fits for minutes";
  const AreaLightTable table = small_fit(parse_analytic("lambert:kd=0.5"), 1);
  const Vec3 wo = spherical_direction(0.8, 0.3);
  EXPECT_NEAR(reflected(table, kSquare, wo).g, 0.5 * cosine_share(kSquare), 0.01 * cosine_share(kSquare));
}

// Integrates f_r cos(theta_i) over a rectangle by its area.
double brute_force(const AnalyticBrdf& brdf, const std::array<Vec3, 4>& lamp, Vec3 wo) {
  const Vec3 u = lamp[1] - lamp[0], v = lamp[3] - lamp[0], n = cross(u, v);
  constexpr int kSide = 300;
  double sum = 0;
  std::array<double, 3> f{};
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const Vec3 at = lamp[0] + ((i + 0.5) / kSide) * u + ((k + 0.5) / kSide) * v;
      const double square = dot(at, at);
      const Vec3 wi = normalize(at);
      if (wi.z <= 0) continue;
      brdf.eval(wi, wo, f);
      sum += f[1] * wi.z * std::abs(dot(wi, n)) / square / (kSide * kSide);
    }
  return sum;
}

TEST(AreaLightFit, LampOverGgxIsNearItsIntegral) {
  if (BURNISH_SANITIZED) GTEST_SKIP() << "fits for minutes";
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.9");
  const AreaLightTable table = small_fit(brdf);
  for (const double theta : {0.2, 0.7, 1.1}) {
    const Vec3 wo = spherical_direction(theta, 2.5);
    const double expected = brute_force(brdf, kSquare, wo);
    EXPECT_NEAR(reflected(table, kSquare, wo).g, expected, 0.05 * expected) << theta;
  }
}

TEST(AreaLightFit, BrushedMetalKeepsItsMirrorImages) {
  if (BURNISH_SANITIZED) GTEST_SKIP() << "fits for minutes";
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.15,alpha_y=0.4,f0=0.9");
  const AreaLightTable table =
      fit_area_lights(brdf, {.lobes = 1, .polars = 9, .quarter = 4, .iterations = 12});
  EXPECT_EQ(table.views, AreaLightViews::quarter);
  const Vec3 wo = spherical_direction(0.7, 0.5);
  const std::array square = rectangle_light(2 * mirror(wo), {0.6, 0, 0.1}, {0, 0.6, 0});
  const double value = reflected(table, square, wo).g, expected = brute_force(brdf, square, wo);
  EXPECT_NEAR(value, expected, 0.1 * expected);
  for (const Vec3 signs : {Vec3{-1, 1, 1}, Vec3{1, -1, 1}, Vec3{-1, -1, 1}}) {
    const auto flipped = [&](Vec3 w) { return Vec3{signs.x * w.x, signs.y * w.y, w.z}; };
    std::array<Vec3, 4> lamp = square;
    for (Vec3& corner : lamp) corner = flipped(corner);
    EXPECT_NEAR(reflected(table, lamp, flipped(wo)).g, value, 1e-9 * value);
  }
}

TEST(AreaLightFit, ViewsBelowTheHorizonAreDarkAndBadOptionsFail) {
  const AnalyticBrdf brdf = parse_analytic("lambert:kd=0.5");
  const AreaLightTable table = small_fit(brdf, 1);
  EXPECT_EQ(reflected(table, kSquare, {0.6, 0, -0.8}), Rgb(0));
  EXPECT_EQ(table.lobe_bytes(), 9u * 16);
  EXPECT_THROW(fit_area_lights(brdf, {.lobes = 4}), Error);
  EXPECT_THROW(fit_area_lights(brdf, {.thetas = 3}), Error);
}

TEST(RectangleFormula, IsTheDefinitionForQuadrilaterals) {
  Pcg32 random(3);
  const auto draw = [&](double size) { return size * (2 * random.uniform() - 1); };
  int cut = 0;
  for (int i = 0; i < 500; ++i) {
    const std::array quad = rectangle_light({draw(2), draw(2), draw(2)}, {draw(1), draw(1), draw(1)},
                                            {draw(1), draw(1), draw(1)});
    const LitQuad<Vec3> lit(quad);
    EXPECT_NEAR(lit.cosine_share(), cosine_share(quad), 2e-5);
    EXPECT_NEAR(lit.lobe_share([](Vec3 w) { return kLobe.to_cosine(w); }), lobe_share(kLobe, quad), 2e-5);
    cut += clipped_above(quad).size() == 5;
  }
  EXPECT_GT(cut, 20);
}

TEST(RectangleFormula, AngleOverSineIsWithinItsBound) {
  for (int i = 0; i < 1000; ++i) {
    const double x = (i + 0.5) / 1000, exact = std::acos(x) / std::sqrt(1 - x * x);
    EXPECT_NEAR(angle_over_sine(x), exact, 5e-6);
    if (x < 0.99) {
      const double other = std::acos(-x) / std::sqrt(1 - x * x);
      EXPECT_NEAR(angle_over_sine(-x), other, 1e-5 * other);
    }
  }
}

// Returns a small table without a fit, whose values vary with the view.
AreaLightTable made_table(AreaLightViews views) {
  AreaLightTable table{.views = views,
                       .thetas = 6,
                       .azimuths = views == AreaLightViews::line ? 1u : 5u,
                       .cosine = {},
                       .lobes = {}};
  table.lobes.resize(2);
  for (std::size_t i = 0; i < table.nodes(); ++i) {
    const auto at = static_cast<float>(i);
    for (const float c : {0.1F, 0.2F, 0.3F}) table.cosine.push_back(c + 0.01F * at);
    for (std::size_t j = 0; j < 2; ++j) {
      const bool line = views == AreaLightViews::line;
      for (const float b : {2 + 0.1F * at, line ? 0 : 0.2F, -0.2F, line ? 0 : 0.1F, 3 - 0.05F * at,
                            line ? 0 : 0.3F, 0.25F, line ? 0 : -0.1F, 1.0F})
        table.lobes[j].inverse.push_back(b);
      for (const float c : {0.5F, 0.3F, 0.1F}) table.lobes[j].amplitude.push_back(c * (j == 0 ? 1 : 0.5F));
    }
  }
  return table;
}

constexpr const char* kCalls =
    "burnish_test_quad(a, a, a, a, a) + burnish_test_quad_world(a, a, a, a, a, a, a), 1.0)";

// Returns a main function that calls both functions.
std::string main_of(ShaderLanguage language) {
  if (language == ShaderLanguage::hlsl || language == ShaderLanguage::slang)
    return fmt::format(
        "float4 main(float4 at : SV_Position) : SV_Target {{ float3 a = at.xyz; return float4({}; }}\n",
        kCalls);
  if (language == ShaderLanguage::wgsl)
    return fmt::format(
        "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {{ let a = at.xyz; return "
        "vec4f({}; }}\n",
        kCalls);
  return fmt::format("out vec4 color;\nvoid main() {{ vec3 a = vec3(0, 0, 1); color = vec4({}; }}\n", kCalls);
}

TEST(AreaLightShader, CompilesInEveryLanguageWithACompiler) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "area_light_shader";
  std::filesystem::create_directories(folder);
  int compiled = 0;
  for (const Checked& checked : kChecked) {
    if (std::system(fmt::format("command -v {} > /dev/null 2>&1", checked.tool).c_str()) != 0) continue;
    std::string files;
    for (const AreaLightViews views : {AreaLightViews::line, AreaLightViews::quarter, AreaLightViews::full}) {
      const std::filesystem::path file = folder / fmt::format("{}_{}.{}", to_string(checked.language),
                                                              static_cast<int>(views), checked.extension);
      std::ofstream(file) << checked.before
                          << generate_shader(made_table(views), checked.language, "test").text
                          << main_of(checked.language);
      files += " " + file.string();
    }
    EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), files), folder / "log"));
    ++compiled;
  }
  if (compiled == 0) GTEST_SKIP() << "no compiler of shaders";
}

TEST(AreaLightShader, NeedsTexturesAndAName) {
  EXPECT_THROW(generate_shader(made_table(AreaLightViews::line), ShaderLanguage::cpp, "test"), Error);
  EXPECT_THROW(generate_shader(made_table(AreaLightViews::line), ShaderLanguage::glsl, "a b"), Error);
}

TEST(AreaLightShader, CountsItsPlaceFromTheBindingThatIsAskedFor) {
  const auto text = [](ShaderLanguage language, const ShaderPlaces& places) {
    return generate_shader(made_table(AreaLightViews::line), language, "test", places).text;
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(text(ShaderLanguage::glsl, {.binding = 2, .set = 1}),
              HasSubstr("layout(set = 1, binding = 10) uniform sampler2D burnish_test_area;"));
  EXPECT_THAT(text(ShaderLanguage::wgsl, {.binding = 2, .set = 1}),
              HasSubstr("@group(1) @binding(18) var burnish_test_area: texture_2d<f32>;"));
  EXPECT_THROW(text(ShaderLanguage::glsl, {.binding = -1}), Error);
}

TEST(AreaLightShader, ComputesWhatTheTableSays) {
  const TestContext gl;
  if (!gl.context) GTEST_SKIP() << gl.reason;
  for (const AreaLightViews views : {AreaLightViews::line, AreaLightViews::quarter, AreaLightViews::full}) {
    const AreaLightTable table = made_table(views);
    const AreaLightShader shader = generate_shader(table, ShaderLanguage::glsl, "test");
    GlFunction function(shader.text +
                            "vec3 lit(vec3 wo, vec3 c) { vec3 u = vec3(.5, .1, .2), v = vec3(-.1, .4, .3);\n"
                            "  return burnish_test_quad(wo, c - u - v, c + u - v, c + u + v, c - u + v); }\n",
                        "lit");
    function.set_texture(upload_of(shader.texture, TableFormat::single, true));
    Pcg32 random(9);
    std::vector<GlVectors> calls;
    std::vector<Rgb> expected;
    for (int i = 0; i < 300; ++i) {
      const Vec3 wo = spherical_direction(1.5 * random.uniform(), kTwoPi * random.uniform());
      const Vec3 c{3 * random.uniform() - 1.5, 3 * random.uniform() - 1.5, 2 * random.uniform() - 0.4};
      calls.push_back({{static_cast<float>(wo.x), static_cast<float>(wo.y), static_cast<float>(wo.z)},
                       {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)}});
      expected.push_back(reflected(table, rectangle_light(c, {.5, .1, .2}, {-.1, .4, .3}), wo));
    }
    const std::vector<float> got = function.call(calls);
    for (std::size_t i = 0; i < calls.size(); ++i) {
      // Texture units interpolate between nodes with weights of 8 bits.
      EXPECT_NEAR(static_cast<double>(got[3 * i]), expected[i].r, 4e-3) << i;
      EXPECT_NEAR(static_cast<double>(got[3 * i + 2]), expected[i].b, 4e-3) << i;
    }
  }
}

}  // namespace
}  // namespace burnish
