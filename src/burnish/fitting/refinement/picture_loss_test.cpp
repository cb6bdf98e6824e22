// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/fitting/refinement/picture_loss_lanes.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

constexpr ErrorTerms kOnes{.pictures = 1, .dimmed = 1, .relative = 1, .log_cos = 1, .absolute = 1};

TEST(PictureLoss, SlopeIsTheDerivativeOfTheErrors) {
  const PictureLoss loss{.shares = kOnes, .exposure = 2};
  for (const bool picture : {true, false})
    for (const double f : {0.0, 1e-3, 0.2, 0.4})
      for (const double model : {1e-4, 0.05, 0.3, 0.45}) {
        const auto value = [&](double log_model) {
          ErrorTerms sums{};
          loss.add(loss.target(f, 0.8, picture), std::exp(log_model), 0.8, picture, 1, kOnes, sums);
          return sums.pictures + sums.dimmed + sums.relative + sums.log_cos + sums.absolute;
        };
        ErrorTerms sums{};
        const auto slope = loss.add(loss.target(f, 0.8, picture), model, 0.8, picture, 1, kOnes, sums);
        const double x = std::log(model), h = 1e-4;
        EXPECT_NEAR(slope.gradient, (value(x + h) - value(x - h)) / (2 * h), 1e-5) << f << ' ' << model;
        EXPECT_GE(slope.curvature, 0);
      }
}

TEST(PictureLoss, IsZeroWhereTheModelIsRight) {
  const PictureLoss loss{.exposure = 3};
  for (const bool picture : {true, false}) {
    ErrorTerms sums{};
    const auto slope = loss.add(loss.target(0.1, 0.5, picture), 0.1, 0.5, picture, 1, kOnes, sums);
    for (const double s : {sums.pictures, sums.dimmed, sums.relative, sums.log_cos, sums.absolute})
      EXPECT_NEAR(s, 0, 1e-12);
    EXPECT_NEAR(slope.gradient, 0, 1e-4);
  }
}

TEST(PictureLoss, IsTheSameInLanes) {
  constexpr std::size_t kCount = 256;
  const PictureLoss loss{.exposure = 2};
  const ErrorTerms derivatives{.pictures = 3, .dimmed = 1, .relative = 0.5, .log_cos = 2, .absolute = 4};
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
  for (const auto term : {&ErrorTerms::pictures, &ErrorTerms::dimmed, &ErrorTerms::relative,
                          &ErrorTerms::log_cos, &ErrorTerms::absolute})
    EXPECT_NEAR(sums.*term, expected.*term, 1e-5 * expected.*term);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(gradient[i], slopes[i].gradient, 1e-5 * (1 + std::abs(slopes[i].gradient))) << i;
    EXPECT_NEAR(curvature[i], slopes[i].curvature, 1e-4 * slopes[i].curvature) << i;
  }
}

}  // namespace
}  // namespace burnish
