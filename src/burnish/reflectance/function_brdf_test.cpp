// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/function_brdf.h>

namespace burnish {
namespace {

FunctionBrdf product_of_cosines() {
  return {2, true, [](std::span<const DirectionPair> pairs, std::span<double> values) {
            for (std::size_t i = 0; i < pairs.size(); ++i) {
              values[2 * i] = pairs[i].wi.z * pairs[i].wo.z;
              values[2 * i + 1] = 7;
            }
          }};
}

TEST(FunctionBrdf, GivesTheFunctionsValuesAboveTheHorizonAndZerosBelow) {
  const FunctionBrdf brdf = product_of_cosines();
  const Vec3 up{0, 0, 1}, tilted{0.6, 0, 0.8}, down{0.6, 0, -0.8};
  const std::vector<DirectionPair> pairs{{down, up}, {up, tilted}, {up, down}, {tilted, tilted}};
  std::vector<double> values(8, -1);
  std::vector<std::uint8_t> known(4, 0);
  brdf.eval(pairs, values, known);
  EXPECT_EQ(values, (std::vector<double>{0, 0, 0.8, 7, 0, 0, 0.8 * 0.8, 7}));
  EXPECT_EQ(known, std::vector<std::uint8_t>(4, 1));
  std::vector<double> one(2);
  EXPECT_TRUE(brdf.eval(up, tilted, one));
  EXPECT_EQ(one, (std::vector<double>{0.8, 7}));
}

TEST(FunctionBrdf, IsAskedOnlyOfDirectionsAboveTheHorizon) {
  bool below = false;
  std::size_t calls = 0;
  const FunctionBrdf brdf(1, true, [&](std::span<const DirectionPair> pairs, std::span<double>) {
    ++calls;
    for (const auto& [wi, wo] : pairs) below = below || wi.z <= 0 || wo.z <= 0;
  });
  const std::vector<DirectionPair> pairs{
      {{0, 0, -1}, {0, 0, 1}}, {{0, 0, 1}, {1, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}};
  std::vector<double> values(3);
  std::vector<std::uint8_t> known(3);
  brdf.eval(pairs, values, known);
  EXPECT_EQ(calls, 1u);
  brdf.eval(std::span(pairs).first(2), std::span(values).first(2), std::span(known).first(2));
  EXPECT_EQ(calls, 1u);
  EXPECT_FALSE(below);
}

TEST(FunctionBrdf, WhatItThrowsIsUnknownAndIsThrownWhenAskedFor) {
  bool fails = true;
  const FunctionBrdf brdf(1, true, [&](std::span<const DirectionPair>, std::span<double> values) {
    if (fails) throw std::out_of_range("mine");
    values[0] = 3;
  });
  const std::size_t before = brdf.failures();
  std::vector<double> f{5};
  EXPECT_FALSE(brdf.eval({0, 0, 1}, {0, 0, 1}, f));
  EXPECT_EQ(f[0], 0);
  EXPECT_THROW(brdf.rethrow_since(before), std::out_of_range);
  EXPECT_THROW(brdf.rethrow_since(before), Error);  // who began as early has unknown values too
  EXPECT_NO_THROW(brdf.rethrow_since(brdf.failures()));
  fails = false;
  EXPECT_TRUE(brdf.eval({0, 0, 1}, {0, 0, 1}, f));
  EXPECT_EQ(f[0], 3);
}

TEST(FunctionBrdf, LoopsInsideItTakeUpNoWorkFromOutside) {
  // else a thread would be asked while it is being asked, which what holds a lock cannot bear
  static thread_local int depth = 0;
  std::atomic<int> deepest = 0;
  const FunctionBrdf brdf(1, true, [&](std::span<const DirectionPair>, std::span<double>) {
    ++depth;
    if (depth > deepest) deepest = depth;
    for_each_chunk(16, 1, [](std::size_t, std::size_t, std::size_t) { std::this_thread::yield(); });
    --depth;
  });
  for_each_chunk(200, 1, [&](std::size_t, std::size_t, std::size_t) {
    double f = 0;
    brdf.eval({0, 0, 1}, {0, 0, 1}, {&f, 1});
  });
  EXPECT_EQ(deepest, 1);
}

TEST(FunctionBrdf, RefusesNoFunctionAndNoChannels) {
  const auto nothing = [](std::span<const DirectionPair>, std::span<double>) {};
  EXPECT_THROW(FunctionBrdf(1, true, {}), Error);
  EXPECT_THROW(FunctionBrdf(0, true, nothing), Error);
  EXPECT_THROW(FunctionBrdf(SymmetrizedBrdf::kMaxChannels + 1, true, nothing), Error);
}

}  // namespace
}  // namespace burnish
