// SPDX-License-Identifier: Apache-2.0
#include <mutex>
#include <set>

#include <gtest/gtest.h>

#include <burnish/capture/ranks/shared_work.h>
#include <burnish/math/random.h>
#include <burnish/testing/crews.h>
#include <burnish/testing/directions.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

TEST(MadeTogether, IsTheSameInOrderAtEveryRankAndMadeOnce) {
  for (const std::size_t count : {0, 1, 3, 8})
    for (const int ranks : {1, 2, 3, 5}) {
      std::mutex mutex;
      std::multiset<std::size_t> made;
      const auto make_at = [&](int rank) {
        return [&, rank](std::size_t i) {
          if (rank >= 0) {
            EXPECT_EQ(i % static_cast<std::size_t>(ranks), static_cast<std::size_t>(rank));
            const std::scoped_lock lock(mutex);
            made.insert(i);
          }
          // The results differ in length, one is empty, and some have bytes that end a C string.
          return std::string(i % 4, static_cast<char>('a' + i)) + std::string(i % 2, '\0');
        };
      };
      const std::vector<std::string> alone = made_together(nullptr, count, make_at(-1));
      ASSERT_EQ(alone.size(), count);
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(alone[i], make_at(-1)(i));
      for (const auto& found : at_every_rank(
               ranks, [&](FitCrew* crew) { return made_together(crew, count, make_at(crew->rank())); }))
        EXPECT_EQ(found, alone) << count << " of " << ranks;
      EXPECT_EQ(made.size(), count);
      EXPECT_EQ(std::set(made.begin(), made.end()).size(), count);
    }
}

/// Pixels at random, some of them missing. Each is seen along directions of its own.
TexelSamples some_samples(std::size_t texels, std::size_t pictures) {
  TexelSamples samples{.texels = {}, .pictures = pictures, .values = {}, .states = {}};
  Pcg32 random(4);
  for (std::size_t t = 0; t < texels; ++t) samples.texels.push_back({static_cast<int>(t), 0});
  for (std::size_t i = 0; i < texels * pictures; ++i) {
    for (int c = 0; c < 3; ++c) samples.values.push_back(static_cast<float>(random.uniform()));
    samples.states.push_back(random.next() % 8 == 0 ? PixelState::missing : PixelState::there);
    for (int k = 0; k < 2; ++k) {
      const Vec3 w = random_upper_direction(random);
      for (const double x : {w.x, w.y, w.z}) samples.directions.push_back(static_cast<float>(x));
    }
  }
  return samples;
}

TEST(SolveTogether, GivesTheSameBitsForAnyNumberOfRanks) {
  constexpr std::size_t kTexels = 7, kPictures = 5;
  CaptureForm form{.width = kTexels, .height = 1, .normals = {}, .pictures = {}};
  form.pictures.resize(kPictures);
  form.own_directions = true;
  const TexelSamples samples = some_samples(kTexels, kPictures);
  const TexelSolver solver(random_model("q(theta_h) + r(theta_d)", {"q=8", "r=5"}, 3, TableFormat::single),
                           form, 1);
  std::vector<float> tilted;
  for (std::size_t t = 0; t < 2 * kTexels; ++t) tilted.push_back(0.05f * static_cast<float>(t) - 0.3f);
  for (const auto& [normals, options] : {std::pair<std::vector<float>, TexelSolver::Options>{{}, {}},
                                         {{}, {.trust = true, .costs = true}},
                                         {tilted, {.costs = true}},
                                         {tilted, {.normals = true, .normal_steps = 2, .trust = true}}}) {
    const TexelFits alone = solve_together(nullptr, solver, samples, normals, options);
    ASSERT_EQ(alone.weights.size(), 2 * kTexels);
    for (const int ranks : {2, 3, 9})  // some of nine ranks have no texel
      for (const TexelFits& found : at_every_rank(ranks, [&, n = normals, o = options](FitCrew* crew) {
             return solve_together(crew, solver, samples, n, o);
           })) {
        EXPECT_EQ(found.weights, alone.weights) << ranks;
        EXPECT_EQ(found.normals, alone.normals) << ranks;
        EXPECT_EQ(found.trust, alone.trust) << ranks;
        EXPECT_EQ(found.costs, alone.costs) << ranks;
      }
  }
}

}  // namespace
}  // namespace burnish
