// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/capture/texels/nonnegative.h>
#include <burnish/capture/texels/texel_lanes.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {
namespace {

constexpr float kUntouched = -77;  // a value that kernels must not change
constexpr std::size_t kLaneChannels = 3;

std::vector<float> some_floats(std::size_t count, float least, float most, Pcg32& random) {
  std::vector<float> values(count);
  for (float& value : values) value = least + (most - least) * static_cast<float>(random.uniform());
  return values;
}
TexelRow some_row(float least, float most, Pcg32& random) {
  TexelRow row;
  std::ranges::copy(some_floats(kTexelLanes, least, most, random), row.begin());
  return row;
}

void expect_close(float found, double expected, double relative, const std::string& where) {
  EXPECT_NEAR(static_cast<double>(found), expected, relative * (std::abs(expected) + 1e-6)) << where;
}

// Vectors of length 1 and others turn into rows that are side by side or apart. Floats between the rows do not
// change.
TEST(TexelLanes, VectorsTurnIntoFramesAsOneByOne) {
  Pcg32 random(11);
  for (const bool any_length : {false, true})
    for (const std::size_t plane : {kTexelLanes, kTexelLanes + 1, 4 * kTexelLanes}) {
      TexelFrames frames;
      for (TexelRow& row : frames) row = some_row(-1, 1, random);
      std::array<TexelRow, 3> towards;
      for (TexelRow& row : towards) row = some_row(-5, 5, random);
      for (TexelRow& row : towards) row[9] = 0;  // has no direction
      std::vector<float> local(3 * plane, kUntouched);
      turn_into(frames, towards, any_length, local.data(), plane);
      for (std::size_t i = 0; i < kTexelLanes; ++i) {
        std::array<double, 3> w;
        for (std::size_t k = 0; k < 3; ++k) w[k] = static_cast<double>(towards[k][i]);
        const double length = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        if (any_length && length > 0)
          for (double& component : w) component /= length;
        else if (any_length)
          w = {0, 0, 1};
        for (std::size_t r = 0; r < 3; ++r) {
          double along = 0;
          for (std::size_t k = 0; k < 3; ++k) along += static_cast<double>(frames[3 * r + k][i]) * w[k];
          EXPECT_NEAR(static_cast<double>(local[r * plane + i]), along, 1e-5) << plane << ' ' << i;
        }
      }
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t i = kTexelLanes; i < plane; ++i) EXPECT_EQ(local[r * plane + i], kUntouched);
    }
}

TEST(TexelLanes, ProductsAreThoseOfEachTexel) {
  Pcg32 random(12);
  for (const std::size_t rows : {1, 2, 9, 48})
    for (const std::size_t plane : {kTexelLanes, 4 * kTexelLanes}) {
      std::vector<float> f = some_floats(rows * plane, 0, 10, random);
      f[3] = NAN;
      f[(rows - 1) * plane + 31] = INFINITY;
      const TexelRow cosine = some_row(-0.2f, 1, random);
      constexpr float kMost = 4;
      std::vector<float> product(rows * kTexelLanes + 1, kUntouched);
      find_products(rows, f.data(), plane, cosine.data(), kMost, product.data());
      for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t i = 0; i < kTexelLanes; ++i) {
          const float value = f[r * plane + i] * cosine[i], found = product[r * kTexelLanes + i];
          if (std::isnan(value))
            EXPECT_TRUE(std::isnan(found)) << r << ' ' << i;
          else
            EXPECT_EQ(found, std::min(value, kMost)) << r << ' ' << i;
        }
      EXPECT_EQ(product.back(), kUntouched);
    }
}

TEST(TexelLanes, ValuesComeApartByChannels) {
  Pcg32 random(13);
  const std::vector<float> values = some_floats(kLaneChannels * kTexelLanes, -1, 1, random);
  std::array<TexelRow, kLaneChannels + 1> rows;
  rows.back().fill(kUntouched);
  take_apart(values.data(), rows.data());
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    for (std::size_t c = 0; c < kLaneChannels; ++c) EXPECT_EQ(rows[c][i], values[kLaneChannels * i + c]);
    EXPECT_EQ(rows.back()[i], kUntouched);
  }
}

TEST(TexelLanes, SumsAreOfAllLobes) {
  Pcg32 random(14);
  for (std::size_t lobes = 0; lobes <= kMaxSurfaceLobes; ++lobes)
    for (const std::size_t stride : {kTexelLanes, kLaneChannels * kTexelLanes}) {
      const std::vector<float> model = some_floats(lobes * stride + kTexelLanes, 0, 3, random);
      std::vector<TexelRow> weights(lobes);
      for (TexelRow& row : weights) row = some_row(0, 2, random);
      std::array<float, kTexelLanes + 1> total;
      total.fill(kUntouched);
      sum_lobes({.lobes = lobes, .model = model.data(), .stride = stride, .value = nullptr}, weights.data(),
                total.data());
      for (std::size_t i = 0; i < kTexelLanes; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < lobes; ++j)
          sum += static_cast<double>(weights[j][i]) * static_cast<double>(model[j * stride + i]);
        expect_close(total[i], sum, 1e-5, fmt::format("{} lobes, texel {}", lobes, i));
      }
      EXPECT_EQ(total.back(), kUntouched);
    }
}

/// Computes find_omega by the definition in its header: the square of d (x^(1/2)) / d value, from 1 on over x^2,
/// times the share.
double plain_omega(double exposure, double floor, double at, double share) {
  const double x = std::max(exposure * at, floor);
  const double slope = x < 1 ? 0.5 * exposure / std::sqrt(x) : 0.5 * exposure / (x * std::sqrt(x));
  return share * slope * slope;
}

TEST(TexelLanes, OmegaIsTheSquareOfTheRootsSlope) {
  Pcg32 random(15);
  for (const float exposure : {0.1f, 1.0f, 7.0f})
    for (const float floor : {0.004f, 0.5f}) {
      TexelRow at = some_row(0, 3, random), share = some_row(0, 1, random);
      at[0] = 0;
      at[1] = -1;
      at[2] = 1000;
      share[3] = 0;
      std::array<float, kTexelLanes + 1> omega;
      omega.fill(kUntouched);
      find_omega(exposure, floor, at.data(), share.data(), omega.data());
      for (std::size_t i = 0; i < kTexelLanes; ++i)
        expect_close(omega[i],
                     plain_omega(static_cast<double>(exposure), static_cast<double>(floor),
                                 static_cast<double>(at[i]), static_cast<double>(share[i])),
                     1e-5, fmt::format("exposure {}, texel {}", exposure, i));
      EXPECT_EQ(omega.back(), kUntouched);
    }
}

// Pictures at random with some missing and some clipped pixels.
struct SomePictures {
  std::size_t lobes, channels, pictures;
  std::vector<float> model, value, there, clipped;
  std::vector<TexelRow> weights;

  SomePictures(std::size_t lobe_count, std::size_t channel_count, std::size_t picture_count, Pcg32& random)
      : lobes(lobe_count),
        channels(channel_count),
        pictures(picture_count),
        model(some_floats(pictures * lobes * channels * kTexelLanes, 0, 1, random)),
        value(some_floats(pictures * channels * kTexelLanes, 0, 2, random)),
        weights(lobes) {
    for (std::size_t i = 0; i < pictures * kTexelLanes; ++i) there.push_back(random.next() % 5 > 0 ? 1 : 0);
    for (std::size_t i = 0; i < value.size(); ++i) clipped.push_back(random.next() % 4 == 0 ? 1 : 0);
    for (TexelRow& row : weights) row = some_row(0, 1, random);
  }
  TexelPictures pixels(bool clips) const {
    return {.lobes = lobes,
            .channels = channels,
            .pictures = pictures,
            .model = model.data(),
            .value = value.data(),
            .there = there.data(),
            .clipped = clips ? clipped.data() : nullptr};
  }
};

// The sums of one texel, by the definition of TexelPass, in double.
struct PlainEquations {
  std::vector<double> matrix, vector, trust;

  PlainEquations(const SomePictures& some, bool clips, const TexelPass& pass, std::size_t i)
      : matrix(some.lobes * (some.lobes + 1) / 2), vector(some.lobes) {
    const auto exposure = static_cast<double>(pass.exposure), reach = static_cast<double>(pass.reach);
    const auto of = [&](const std::vector<float>& values, std::size_t row) {
      return static_cast<double>(values[row * kTexelLanes + i]);
    };
    for (std::size_t k = 0; k < some.pictures; ++k) {
      std::vector<double> omega;
      double worst = 0;
      for (std::size_t c = 0; c < some.channels; ++c) {
        const std::size_t row = k * some.channels + c;
        const double value = of(some.value, row);
        double total = 0;
        for (std::size_t j = 0; j < some.lobes; ++j)
          total += static_cast<double>(some.weights[j][i]) * lobe(some, i, k, j, c);
        const bool above = clips && of(some.clipped, row) > 0 && total > value && !pass.of_measured;
        const double share = above ? 0 : of(some.there, k);
        omega.push_back(plain_omega(exposure, static_cast<double>(pass.floor),
                                    pass.of_measured ? value : (value + total) / 2, share));
        const double rest = value - total;
        worst =
            std::max(worst, (rest < 0 ? 1 : static_cast<double>(pass.brighter)) * omega.back() * rest * rest);
      }
      const double doubt = 1 + worst / (reach * reach);
      trust.push_back(pass.of_measured ? 1 : of(some.there, k) / (doubt * doubt));
      for (std::size_t c = 0; c < some.channels; ++c)
        for (std::size_t j = 0, at = 0; j < some.lobes; ++j) {
          const double scaled = omega[c] * trust.back() * lobe(some, i, k, j, c);
          vector[j] += scaled * of(some.value, k * some.channels + c);
          for (std::size_t l = 0; l <= j; ++l, ++at) matrix[at] += scaled * lobe(some, i, k, l, c);
        }
    }
  }

 private:
  static double lobe(const SomePictures& some, std::size_t i, std::size_t k, std::size_t j, std::size_t c) {
    return static_cast<double>(some.model[((k * some.lobes + j) * some.channels + c) * kTexelLanes + i]);
  }
};

void expect_plain_equations(const SomePictures& some, bool of_measured, bool clips) {
  const TexelPass pass{
      .of_measured = of_measured, .exposure = 1.5f, .floor = 0.01f, .reach = 0.2f, .brighter = 0.0625f};
  std::vector<TexelRow> matrix(some.lobes * (some.lobes + 1) / 2 + 1), vector(some.lobes + 1);
  matrix.back().fill(kUntouched);
  vector.back().fill(kUntouched);
  std::vector<float> trust(some.pictures * kTexelLanes + 1, kUntouched);
  find_normal_equations(some.pixels(clips), pass, some.weights.data(), trust.data(), matrix.data(),
                        vector.data());
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    const PlainEquations plain(some, clips, pass, i);
    const std::string where =
        fmt::format("{} lobes, {} channels, {} pictures, {}{} texel {}", some.lobes, some.channels,
                    some.pictures, of_measured ? "measured, " : "", clips ? "clipped," : "", i);
    for (std::size_t at = 0; at + 1 < matrix.size(); ++at)
      expect_close(matrix[at][i], plain.matrix[at], 1e-4, where);
    for (std::size_t j = 0; j < some.lobes; ++j) expect_close(vector[j][i], plain.vector[j], 1e-4, where);
    for (std::size_t k = 0; k < some.pictures; ++k) {
      if (of_measured)
        EXPECT_EQ(trust[k * kTexelLanes + i], kUntouched) << where;
      else
        expect_close(trust[k * kTexelLanes + i], plain.trust[k], 1e-4, where);
    }
    EXPECT_EQ(matrix.back()[i], kUntouched);
    EXPECT_EQ(vector.back()[i], kUntouched);
  }
  EXPECT_EQ(trust.back(), kUntouched);
}

// All numbers of lobes are tried; some of them have a kernel of their own.
TEST(TexelLanes, NormalEquationsAreSumsOverPicturesAndChannels) {
  Pcg32 random(16);
  for (std::size_t lobes = 1; lobes <= kMaxSurfaceLobes; ++lobes)
    for (const auto& [channels, pictures] : {std::pair{1, 1}, {3, 0}, {3, 1}, {3, 6}, {2, 3}}) {
      const SomePictures some(lobes, static_cast<std::size_t>(channels), static_cast<std::size_t>(pictures),
                              random);
      for (const bool of_measured : {false, true})
        for (const bool clips : {false, true}) expect_plain_equations(some, of_measured, clips);
    }
}

// Equations side by side, in the layout of find_normal_equations, some of which are not finite.
struct SomeEquations {
  std::vector<TexelRow> matrix, vector, weights;
};
SomeEquations some_equations(std::size_t n, Pcg32& random) {
  SomeEquations some{.matrix = std::vector<TexelRow>(n * (n + 1) / 2),
                     .vector = std::vector<TexelRow>(n),
                     .weights = std::vector<TexelRow>(n)};
  for (std::size_t lane = 0; lane < kTexelLanes; ++lane) {
    std::vector<double> m((n + 3) * n);
    for (double& value : m) value = random.uniform();
    for (std::size_t i = 0, at = 0; i < n; ++i) {
      some.vector[i][lane] = static_cast<float>(2 * random.uniform() - 0.7);
      some.weights[i][lane] = random.next() % 3 == 0 ? 0 : static_cast<float>(random.uniform());
      for (std::size_t j = 0; j <= i; ++j, ++at) {
        double sum = i == j ? 1e-3 : 0;
        for (std::size_t r = 0; r < n + 3; ++r) sum += m[r * n + i] * m[r * n + j];
        some.matrix[at][lane] = static_cast<float>(sum);
      }
    }
  }
  return some;
}

/// Returns the equations that find_weights solves in one lane: the whole matrix, with the ridge, and the right side.
std::pair<std::vector<double>, std::vector<double>> equations_of_lane(const SomeEquations& some, double ridge,
                                                                      std::size_t lane) {
  const std::size_t n = some.vector.size();
  std::vector<double> a(n * n), b(n);
  double trace = 0;
  for (std::size_t i = 0, at = 0; i < n; ++i) {
    b[i] = static_cast<double>(some.vector[i][lane]);
    for (std::size_t j = 0; j <= i; ++j, ++at)
      a[i * n + j] = a[j * n + i] = static_cast<double>(some.matrix[at][lane]);
    trace += a[i * n + i];
  }
  for (std::size_t i = 0; i < n; ++i) a[i * n + i] += ridge * trace / static_cast<double>(n) + 1e-30;
  return {a, b};
}

/// Returns the minimum of w' a w / 2 - b' w with w >= 0. Each subset of the unknowns is set free in turn, with the
/// others at 0, and solved by elimination. The result is the solution with the least sum among those without a
/// negative unknown.
std::vector<double> least_of_all_subsets(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t n = b.size();
  std::vector<double> best(n);
  double least = 0;  // the value of all zeros
  for (std::size_t subset = 1; subset < std::size_t{1} << n; ++subset) {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < n; ++i)
      if ((subset >> i & 1U) != 0) free.push_back(i);
    const std::size_t m = free.size();
    std::vector<std::vector<double>> rows(m, std::vector<double>(m + 1));
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t j = 0; j < m; ++j) rows[i][j] = a[free[i] * n + free[j]];
      rows[i][m] = b[free[i]];
    }
    for (std::size_t k = 0; k < m; ++k)
      for (std::size_t i = 0; i < m; ++i) {
        if (i == k) continue;
        const double share = rows[i][k] / rows[k][k];
        for (std::size_t j = k; j <= m; ++j) rows[i][j] -= share * rows[k][j];
      }
    std::vector<double> w(n);
    double sum = 0, lowest = 0;
    for (std::size_t i = 0; i < m; ++i) {
      w[free[i]] = rows[i][m] / rows[i][i];
      lowest = std::min(lowest, w[free[i]]);
      sum -= b[free[i]] * w[free[i]] / 2;  // since a w = b there
    }
    if (lowest < 0 || sum >= least) continue;
    least = sum;
    best = w;
  }
  return best;
}

TEST(TexelLanes, WeightsAreTheLeastOfAllSubsets) {
  constexpr double kSomeRidge = 1e-6;
  Pcg32 random(17);
  for (std::size_t n = 1; n <= 5; ++n)
    for (const bool near : {false, true}) {
      SomeEquations some = some_equations(n, random);
      const std::uint32_t found =
          find_weights(n, some.matrix.data(), some.vector.data(), kSomeRidge, near, some.weights.data());
      EXPECT_EQ(found, ~std::uint32_t{0}) << n;
      for (std::size_t lane = 0; lane < kTexelLanes; ++lane) {
        const auto [a, b] = equations_of_lane(some, kSomeRidge, lane);
        const std::vector<double> expected = least_of_all_subsets(a, b);
        for (std::size_t i = 0; i < n; ++i)
          EXPECT_NEAR(static_cast<double>(some.weights[i][lane]), expected[i], 1e-5 * (1 + expected[i]))
              << n << ' ' << lane;
      }
    }
}

TEST(TexelLanes, WeightsAreTheOtherSolvers) {
  constexpr double kSomeRidge = 1e-6;
  Pcg32 random(9);
  std::size_t found_of_all = 0, all = 0, at_bound = 0;
  for (std::size_t n = 1; n <= kMaxSurfaceLobes; ++n)
    for (const bool near : {false, true}) {
      SomeEquations some = some_equations(n, random);
      const std::vector<TexelRow> before = some.weights;
      const std::uint32_t found =
          find_weights(n, some.matrix.data(), some.vector.data(), kSomeRidge, near, some.weights.data());
      for (std::size_t lane = 0; lane < kTexelLanes; ++lane) {
        const auto [a, b] = equations_of_lane(some, kSomeRidge, lane);
        std::vector<double> w(n);
        solve_nonnegative(a, b, w);
        const bool is_found = (found >> lane & 1U) != 0;
        for (std::size_t i = 0; i < n; ++i) {
          if (is_found)
            EXPECT_NEAR(static_cast<double>(some.weights[i][lane]), w[i], 1e-5 * (1 + w[i]))
                << n << ' ' << lane;
          else
            EXPECT_EQ(some.weights[i][lane], before[i][lane]);
          at_bound += is_found && w[i] == 0;
        }
        found_of_all += is_found;
        ++all;
      }
    }
  EXPECT_GT(found_of_all, all * 9 / 10);
  EXPECT_GT(at_bound, all);
}

TEST(TexelLanes, WeightsOfWhatIsNotFiniteAreLeftToTheOtherSolver) {
  Pcg32 random(2);
  for (const bool near : {false, true})
    for (const float value : {NAN, INFINITY, -INFINITY})
      for (const bool in_matrix : {false, true}) {
        SomeEquations some = some_equations(3, random);
        (in_matrix ? some.matrix[2] : some.vector[1])[7] = value;
        const std::vector<TexelRow> before = some.weights;
        const std::uint32_t found =
            find_weights(3, some.matrix.data(), some.vector.data(), 1e-6, near, some.weights.data());
        EXPECT_EQ(found >> 7 & 1U, 0u);
        EXPECT_NE(found, 0u);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(some.weights[i][7], before[i][7]);
      }
}

TEST(TexelLanes, VectorsTurnIntoFrames) {
  Pcg32 random(4);
  TexelFrames frames;
  std::array<ShadingFrame, kTexelLanes> exact;
  std::array<TexelRow, 3> towards;
  std::array<Vec3, kTexelLanes> vectors;
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    exact[i] = frame_about(normalize({random.uniform() - 0.5, random.uniform() - 0.5, 1}), {1, 0, 0});
    std::size_t row = 0;
    for (const Vec3& axis : {exact[i].tangent, exact[i].bitangent, exact[i].normal})
      for (const double x : {axis.x, axis.y, axis.z}) frames[row++][i] = static_cast<float>(x);
    vectors[i] =
        3 * random.uniform() * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()};
  }
  vectors[5] = {0, 0, 1e-25};  // no direction: (0, 0, 1)
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    towards[0][i] = static_cast<float>(vectors[i].x);
    towards[1][i] = static_cast<float>(vectors[i].y);
    towards[2][i] = static_cast<float>(vectors[i].z);
  }
  std::array<float, 3 * kTexelLanes> local;
  turn_into(frames, towards, true, local.data(), kTexelLanes);
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    const Vec3 expected = exact[i].local(i == 5 ? Vec3{0, 0, 1} : normalize(vectors[i]));
    EXPECT_NEAR(static_cast<double>(local[i]), expected.x, 1e-6) << i;
    EXPECT_NEAR(static_cast<double>(local[kTexelLanes + i]), expected.y, 1e-6) << i;
    EXPECT_NEAR(static_cast<double>(local[2 * kTexelLanes + i]), expected.z, 1e-6) << i;
  }
}

TEST(TexelLanes, SeenValuesAreRoots) {
  TexelRow value, seen;
  for (std::size_t i = 0; i < kTexelLanes; ++i)
    value[i] = static_cast<float>(std::exp2(1.0 - static_cast<double>(i)));
  value[30] = 0;
  value[31] = -1;
  find_seen(0.7f, value.data(), seen.data());
  for (std::size_t i = 0; i < kTexelLanes; ++i)
    EXPECT_NEAR(static_cast<double>(seen[i]),
                std::pow(std::clamp(0.7 * static_cast<double>(value[i]), 0.0, 1.0), 1 / 2.2), 1e-6)
        << i;
}

}  // namespace
}  // namespace burnish
