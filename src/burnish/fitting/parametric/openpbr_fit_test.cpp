// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

PicturePairs pairs_of(const OpenPbrParameters& truth) {
  const OpenPbr brdf(truth);
  return picture_pairs(brdf, Scorer(brdf, {.count = 100, .image_size = 64}).exposure());
}

OpenPbrFit recovered(const OpenPbrParameters& truth) {
  return fit_openpbr(pairs_of(truth), {.anisotropic = !OpenPbr(truth).isotropic()});
}

// Every input, to a percent of itself and of what is small.
void expect_close(const OpenPbrParameters& found, const OpenPbrParameters& truth,
                  std::initializer_list<std::string_view> unseen = {}) {
  for (const OpenPbrInput& input : kOpenPbrInputs) {
    if (std::ranges::find(unseen, input.name) != unseen.end()) continue;
    std::visit(
        [&](auto member) {
          const Rgb a = found.*member, b = truth.*member;
          EXPECT_NEAR(a.r, b.r, 0.01 * b.r + 1e-4) << input.name;
          EXPECT_NEAR(a.g, b.g, 0.01 * b.g + 1e-4) << input.name;
          EXPECT_NEAR(a.b, b.b, 0.01 * b.b + 1e-4) << input.name;
        },
        input.member);
  }
}

TEST(OpenPbrFit, RecoversAMetal) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const OpenPbrParameters ggx{.base_color = {0.9, 0.6, 0.3}, .base_metalness = 1, .specular_roughness = 0.4};
  expect_close(recovered(ggx).parameters, ggx);
}

TEST(OpenPbrFit, RecoversACoatedPlastic) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const OpenPbrParameters plastic{.base_color = {0.6, 0.1, 0.05},
                                  .specular_roughness = 0.5,
                                  .specular_ior = 1.4,
                                  .coat_weight = 1,
                                  .coat_roughness = 0.15,
                                  .coat_ior = 1.6};
  expect_close(recovered(plastic).parameters, plastic);
}

// Colours of base and coat, darkening and a film could say nearly the same of these together.
TEST(OpenPbrFit, RecoversWhatIsPlainlyCoated) {
  BURNISH_SKIP_WHERE_SANITIZED();
  for (const OpenPbrParameters& coated :
       {OpenPbrParameters{.base_color = {0.8, 0.1, 0.1}, .coat_weight = 1},  // the coat is a mirror
        OpenPbrParameters{.base_color = {0.2, 0.2, 0.2},
        .specular_roughness = 0.4,
        .coat_weight = 1,
        .coat_roughness = 0.1},
        OpenPbrParameters{.base_color = {0.3, 0.5, 0.1}, .coat_weight = 0.7, .coat_roughness = 0.2},
        OpenPbrParameters{
            .base_color = {0.9, 0.6, 0.3}, .base_metalness = 1, .coat_weight = 1, .coat_roughness = 0.1}})
    expect_close(recovered(coated).parameters, coated);
}

TEST(OpenPbrFit, RecoversASatin) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const OpenPbrParameters satin{.base_color = {0.3, 0.05, 0.4},
                                .base_metalness = 0.6,
                                .specular_roughness = 0.45,
                                .specular_roughness_anisotropy = 0.6,
                                .fuzz_weight = 0.5,
                                .fuzz_color = {0.8, 0.5, 0.9},
                                .fuzz_roughness = 0.4};
  expect_close(recovered(satin).parameters, satin);
}

TEST(OpenPbrFit, RecoversAFilm) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const OpenPbrParameters film{.base_color = 0.8,
                               .base_metalness = 1,
                               .specular_roughness = 0.3,
                               .thin_film_weight = 1,
                               .thin_film_thickness = 0.4};
  expect_close(recovered(film).parameters, film, {"specular_ior"});
}

TEST(OpenPbrFit, GoesDownAndStaysWithinBounds) {
  const OpenPbrParameters truth{.base_color = {0.2, 0.3, 0.4}, .specular_roughness = 0.4};
  const PicturePairs pairs = pairs_of(truth);
  OpenPbrParameters start = truth;
  start.base_color = 0.9;
  start.specular_roughness = 0.1;
  const OpenPbrFit fit = refine_openpbr(pairs, start);
  EXPECT_LT(fit.summary.error_after, 0.01 * fit.summary.error_before);
  for (const OpenPbrInput& input : kOpenPbrInputs)
    std::visit(
        [&](auto member) {
          const Rgb value = fit.parameters.*member;
          EXPECT_GE(std::min({value.r, value.g, value.b}), input.min) << input.name;
          EXPECT_LE(std::max({value.r, value.g, value.b}), input.max) << input.name;
        },
        input.member);
}

// At and beyond what the inputs say: all light reflected, none of a colour, a very sharp and rough highlight, more light
// than comes in.
TEST(OpenPbrFit, KeepsEveryInputWithinItsBoundsWhateverTheSource) {
  BURNISH_SKIP_WHERE_SANITIZED();
  for (const char* spec : {"lambert:kd=1/1/0.001", "ggx:alpha_x=0.02,alpha_y=0.9,f0=1/1/0,kd=0.9",
                           "oren_nayar:kd=1,sigma=1.5", "phong:exponent=1000,ks=5,kd=0"}) {
    const AnalyticBrdf source = parse_analytic(spec);
    const PicturePairs pairs = picture_pairs(source.ref(), 1);
    const OpenPbrParameters found = fit_openpbr(pairs, {.anisotropic = true}).parameters;
    for (const OpenPbrInput& input : kOpenPbrInputs)
      std::visit(
          [&](auto member) {
            const Rgb value = found.*member;
            for (const double x : {value.r, value.g, value.b}) {
              EXPECT_GE(x, input.min) << spec << ' ' << input.name;
              EXPECT_LE(x, input.max) << spec << ' ' << input.name;
            }
          },
          input.member);
  }
}

TEST(OpenPbrFit, IsTheSameForEveryNumberOfThreads) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const OpenPbrParameters truth{.base_color = {0.2, 0.3, 0.4}, .fuzz_weight = 0.4};
  const PicturePairs pairs = pairs_of(truth);
  const OpenPbrParameters all = fit_openpbr(pairs).parameters;
  const ThreadLimit limit(1);
  EXPECT_EQ(fit_openpbr(pairs).parameters, all);
}

TEST(OpenPbrFit, KeepsGreySourcesGrey) {
  const OpenPbrParameters truth{.base_color = 0.4, .specular_roughness = 0.5};
  const OpenPbrFit fit = refine_openpbr(pairs_of(truth), {}, {.grey = true});
  EXPECT_EQ(fit.parameters.base_color.r, fit.parameters.base_color.b);
  EXPECT_EQ(fit.parameters.fuzz_color.r, fit.parameters.fuzz_color.g);
  EXPECT_EQ(fit.parameters.specular_roughness_anisotropy, 0);
}

}  // namespace
}  // namespace burnish
