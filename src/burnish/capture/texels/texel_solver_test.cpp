// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/capture/texels/texel_solver.h>
#include <burnish/capture/texels/texel_starts.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

/// Pixels of texels with random weights and normals, seen by `pictures` lights and views.
struct Scene {
  FactoredBrdf lobes;
  CaptureForm form;
  TexelSamples samples;
  TexelFits truth;

  Scene(std::size_t texels, std::size_t pictures, bool bumps, double noise, double span = 2,
        bool points = false)
      : lobes(random_model("q(theta_h) r(theta_d) + s(theta_h) + t(theta_d)",
                           {"q=16,power:0.5", "r=5", "s=8", "t=4"}, 3, TableFormat::single, span)) {
    form = {.width = static_cast<int>(texels), .height = 1, .normals = {}, .pictures = {}};
    Pcg32 random(21);
    for (std::size_t p = 0; p < pictures; ++p)
      form.pictures.push_back(
          {.file = {},
           .light = {.is_direction = !points,
                     .at = spherical_direction(1.1 * random.uniform(), 6.28 * random.uniform())},
           .view = {.is_direction = !points,
                    .at = spherical_direction(0.5 * random.uniform(), 6.28 * random.uniform())},
           .mask = {}});
    for (std::size_t t = 0; t < texels; ++t) {
      samples.texels.push_back({static_cast<int>(t), 0});
      for (int j = 0; j < 3; ++j)
        truth.weights.push_back(random.next() % 3 == 0 ? 0 : static_cast<float>(0.2 + random.uniform()));
      if (bumps)
        for (int k = 0; k < 2; ++k) truth.normals.push_back(static_cast<float>(0.6 * random.uniform() - 0.3));
    }
    samples.pictures = pictures;
    samples.states.resize(texels * pictures, PixelState::there);
    const FactoredBrdf alone[] = {lobe_alone(lobes, 0), lobe_alone(lobes, 1), lobe_alone(lobes, 2)};
    for (std::size_t p = 0; p < pictures; ++p)
      for (std::size_t t = 0; t < texels; ++t) {
        Vec3 n{0, 0, 1};
        if (bumps) n = {truth.normals[2 * t], truth.normals[2 * t + 1], 0};
        n.z = std::sqrt(1 - n.x * n.x - n.y * n.y);
        const ShadingFrame frame = frame_about(n, {1, 0, 0});
        const Vec3 point = form.point(static_cast<int>(t), 0);
        const Vec3 wi = frame.local(form.pictures[p].light.seen_from(point)),
                   wo = frame.local(form.pictures[p].view.seen_from(point));
        std::array<double, 3> sum{}, f;
        for (std::size_t j = 0; j < 3; ++j) {
          alone[j].eval(wi, wo, f);
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += static_cast<double>(truth.weights[3 * t + j]) * f[c] * std::max(0.0, wi.z);
        }
        for (const double value : sum)
          samples.values.push_back(static_cast<float>(value * std::exp(noise * (random.uniform() - 0.5))));
      }
  }
  double worst_weight(const TexelFits& fits) const {
    double worst = 0;
    for (std::size_t i = 0; i < truth.weights.size(); ++i)
      worst = std::max(worst, std::abs(static_cast<double>(fits.weights[i] - truth.weights[i])));
    return worst;
  }
};

TEST(TexelSolver, RecoversWeightsOfKnownLobes) {
  for (const auto& [bumps, points] : {std::pair(false, false), {true, false}, {true, true}, {false, true}}) {
    const Scene scene(70, 25, bumps, 0, 2, points);
    const TexelSolver solver(scene.lobes, scene.form, 1);
    const TexelFits fits = solver.solve(scene.samples, scene.truth.normals, {});
    EXPECT_LT(scene.worst_weight(fits), 2e-3);
    for (const auto& error : solver.errors(scene.samples, fits)) EXPECT_LT(error.seen_mean().value(), 1e-5);
  }
}

// Weights change little if a twentieth of the pixels is in shadow or misplaced.
TEST(TexelSolver, IsNotLedByShadows) {
  Scene scene(70, 40, false, 0);
  const std::vector<float> lit = scene.samples.values;
  Pcg32 random(2);
  for (std::size_t i = 0; i < scene.samples.states.size(); ++i)
    if (random.next() % 20 == 0) std::fill_n(&scene.samples.values[3 * i], 3, 0.0f);
  const TexelSolver solver(scene.lobes, scene.form, 1);
  const TexelFits robust = solver.solve(scene.samples, {}, {.trust = true}),
                  plain = solver.solve(scene.samples, {}, {.passes = 1});
  double robust_sum = 0, plain_sum = 0;
  for (std::size_t i = 0; i < robust.weights.size(); ++i) {
    robust_sum += std::abs(static_cast<double>(robust.weights[i] - scene.truth.weights[i]));
    plain_sum += std::abs(static_cast<double>(plain.weights[i] - scene.truth.weights[i]));
  }
  EXPECT_LT(robust_sum, 0.3 * plain_sum);
  std::size_t trusted = 0;
  for (std::size_t i = 0; i < robust.trust.size(); ++i)
    trusted += scene.samples.values[3 * i] == 0 && lit[3 * i] > 0.1f && robust.trust[i] > 0.3f;
  EXPECT_EQ(trusted, 0u);
}

// A clipped pixel is only a lower bound. If it were taken as a value, weights would be wrong.
TEST(TexelSolver, TakesClippedPixelsForLowerBounds) {
  Scene scene(70, 40, false, 0), taken = scene;
  // The brightest twentieth of the values is clipped.
  std::vector<float> sorted = scene.samples.values;
  const auto white = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 19 / 20);
  std::ranges::nth_element(sorted, white);
  const float clip = *white;
  for (std::size_t i = 0; i < scene.samples.values.size(); ++i)
    if (float& value = scene.samples.values[i]; value > clip) {
      taken.samples.values[i] = value = clip;
      scene.samples.states[i / 3] = clipped_in(scene.samples.states[i / 3], i % 3);
    }
  const TexelSolver solver(scene.lobes, scene.form, 1);
  const auto mean_error = [&](const TexelSamples& samples) {
    const TexelFits fits = solver.solve(samples, {}, {});
    double sum = 0;
    for (std::size_t i = 0; i < fits.weights.size(); ++i)
      sum += std::abs(static_cast<double>(fits.weights[i] - scene.truth.weights[i]));
    return sum / static_cast<double>(fits.weights.size());
  };
  EXPECT_LT(mean_error(scene.samples), 0.5 * mean_error(taken.samples));
}

TEST(TexelSolver, FindsNormals) {
  const Scene scene(70, 40, true, 0, 0.3);  // this smooth, like diffuse surfaces
  const TexelSolver solver(scene.lobes, scene.form, 1);
  const TexelFits fits = solver.solve(scene.samples, {}, {.normals = true, .normal_steps = 12});
  double sum = 0;
  for (std::size_t i = 0; i < fits.normals.size(); ++i)
    sum += std::abs(static_cast<double>(fits.normals[i] - scene.truth.normals[i]));
  EXPECT_LT(sum / static_cast<double>(fits.normals.size()), 0.03);
}

TEST(TexelSolver, GivesTheSameBitsForAnyThreadsAndBlocks) {
  const Scene scene(70, 20, true, 0.05);
  const TexelSolver solver(scene.lobes, scene.form, 1);
  const TexelSolver::Options options{.normals = true, .trust = true};
  const TexelFits all = solver.solve(scene.samples, {}, options);
  {
    const ThreadLimit one(1);
    const TexelFits again = solver.solve(scene.samples, {}, options);
    EXPECT_EQ(all.weights, again.weights);
    EXPECT_EQ(all.normals, again.normals);
    EXPECT_EQ(all.trust, again.trust);
  }
  // The last 30 texels are fitted alone.
  TexelSamples part{.texels = {scene.samples.texels.begin() + 40, scene.samples.texels.end()},
                    .pictures = scene.samples.pictures,
                    .values = {},
                    .states = {}};
  for (std::size_t p = 0; p < part.pictures; ++p)
    for (std::size_t t = 40; t < 70; ++t) {
      const float* value = &scene.samples.values[3 * (p * 70 + t)];
      part.values.insert(part.values.end(), value, value + 3);
      part.states.push_back(scene.samples.states[p * 70 + t]);
    }
  const TexelFits some = solver.solve(part, {}, options);
  EXPECT_TRUE(std::equal(some.weights.begin(), some.weights.end(), all.weights.begin() + 120));
  EXPECT_TRUE(std::equal(some.normals.begin(), some.normals.end(), all.normals.begin() + 80));
}

// Photometric stereo finds the normals of diffuse texels, a tenth of them in shadow or white.
TEST(DiffuseNormals, AreNotLedByHighlights) {
  Scene scene(40, 40, true, 0);
  Pcg32 random(4);
  for (std::size_t p = 0; p < 40; ++p)
    for (std::size_t t = 0; t < 40; ++t) {
      Vec3 n{scene.truth.normals[2 * t], scene.truth.normals[2 * t + 1], 0};
      n.z = std::sqrt(1 - n.x * n.x - n.y * n.y);
      double value = 0.5 * std::max(0.0, dot(n, scene.form.pictures[p].light.at));
      if (random.next() % 20 == 0) value += 0.8;
      if (random.next() % 20 == 0) value = 0;
      std::fill_n(&scene.samples.values[3 * (p * 40 + t)], 3, static_cast<float>(value));
    }
  const std::vector<float> found = diffuse_normals(scene.samples, scene.form);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], scene.truth.normals[i], 0.03);
}

// Texels are diffuse, of three colours and their mixtures. Each set has one colour.
TEST(PureTexels, TellMaterialsFromTheirMixtures) {
  Scene scene(120, 30, false, 0);
  const auto colour_of = [](std::size_t t) { return t % 3; };
  for (std::size_t p = 0; p < scene.samples.pictures; ++p)
    for (std::size_t t = 0; t < 120; ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const double albedo = t >= 90 ? 0.3 : c == colour_of(t) ? 0.8 : 0.05;
        scene.samples.values[3 * (p * 120 + t) + c] =
            static_cast<float>(albedo * scene.form.pictures[p].light.at.z);
      }
  const auto sets = pure_texels(scene.samples, scene.form, {}, 1, 3);
  ASSERT_EQ(sets.size(), 3u);
  std::array<bool, 3> found{};
  for (const auto& set : sets) {
    ASSERT_FALSE(set.empty());
    for (const std::size_t t : set) {
      EXPECT_LT(t, 90u);
      EXPECT_EQ(colour_of(t), colour_of(set.front()));
    }
    found[colour_of(set.front())] = true;
  }
  EXPECT_TRUE(found[0] && found[1] && found[2]);
}

}  // namespace
}  // namespace burnish
