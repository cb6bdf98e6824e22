// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/surface/surface_file.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/surfaces.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::string seed() {
  return format_surface({.brdf = random_surface(3, 2), .notes = R"({"from":"a test"})"});
}

std::string exr_seed() {
  return format_surface_exr({.brdf = random_surface(3, 2), .notes = R"({"from":"a test"})"});
}

TEST(SurfaceFile, RestoresASurfaceToTheLastBit) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(6, 5), std::pair(64, 33)}) {
    const SurfaceModel surface{.brdf = random_surface(width, height), .notes = R"({"a":[1,2]})"};
    const std::string bytes = format_surface(surface);
    const SurfaceModel read = parse_surface(memory_file(bytes));
    EXPECT_EQ(read, surface);
    EXPECT_EQ(format_surface(read), bytes);
  }
}

TEST(SurfaceFile, IsKnownFromAModelThatIsTheSameEverywhere) {
  const std::string surface = seed(),
                    model = format_compact({.brdf = random_surface(1, 1).lobes(), .lambda_nm = {}});
  EXPECT_TRUE(looks_like_surface(memory_file(surface).bytes));
  EXPECT_FALSE(looks_like_surface(memory_file(model).bytes));
  EXPECT_THAT([&] { parse_compact(memory_file(surface)); },
              ThrowsMessage<Error>(HasSubstr("found a surface")));
  EXPECT_THAT([&] { parse_surface(memory_file(model)); },
              ThrowsMessage<Error>(HasSubstr("expected a surface")));
}

TEST(SurfaceFile, RestoresASurfaceFromOpenExr) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(6, 5), std::pair(64, 33)}) {
    const SurfaceModel surface{.brdf = random_surface(width, height), .notes = R"({"a":[1,2]})"};
    const std::string bytes = format_surface_exr(surface);
    EXPECT_TRUE(looks_like_surface(memory_file(bytes).bytes));
    const SurfaceModel read = parse_surface(memory_file(bytes));
    EXPECT_EQ(read, surface);
    EXPECT_EQ(format_surface_exr(read), bytes);
    EXPECT_EQ(format_surface_as("a/wall.exr", surface), bytes);
    EXPECT_EQ(format_surface_as("wall.burnish", surface), format_surface(surface));
  }
}

TEST(SurfaceFile, OpenExrIsKnownFromThatOfAModel) {
  const std::string surface = format_surface_exr({.brdf = random_surface(3, 2), .notes = "{}"}),
                    model = format_model({.brdf = random_surface(1, 1).lobes(), .lambda_nm = {}});
  EXPECT_FALSE(looks_like_surface(memory_file(model).bytes));
  EXPECT_THAT([&] { parse_model(memory_file(surface)); }, ThrowsMessage<Error>(HasSubstr("found a surface")));
  EXPECT_THAT([&] { parse_surface(memory_file(model)); }, ThrowsMessage<Error>(HasSubstr("found a model")));
}

TEST(SurfaceFile, OpenExrWithOtherValuesOrFormsThrows) {
  const SurfaceModel surface{.brdf = random_surface(3, 2), .notes = "{}"};
  const std::string bytes = format_surface_exr(surface);
  for (const auto& [from, to] :
       {std::pair(R"("width":3)", R"("width":2)"), std::pair(R"("height":2)", R"("height":9)"),
        std::pair("\"unorm8\"", "\"half\"  "), std::pair("map_weight0", "map_weight7")}) {
    std::string other = bytes;
    const auto at = other.find(from, other.find("burnish_surface"));
    ASSERT_NE(at, other.npos) << from;
    other.replace(at, std::string_view(from).size(), to);
    EXPECT_THROW(parse_surface(memory_file(other)), Error) << to;
  }
  // no code of unorm8
  const SurfaceMap& map = surface.brdf.maps().weights.front();
  const float value = map.texel(0, 0)[0], near = value + map.scale() / 700;
  std::string other = bytes;
  const std::string_view code(reinterpret_cast<const char*>(&value), sizeof value);
  const auto at = other.rfind(code);
  ASSERT_NE(at, other.npos);
  std::memcpy(&other[at], &near, sizeof near);
  EXPECT_THAT([&] { parse_surface(memory_file(other)); }, ThrowsMessage<Error>(HasSubstr("found others")));
}

TEST(SurfaceFile, OpenExrWithNamesThatMeetOrTooDeepJsonThrows) {
  SpatialBrdf surface = random_surface(3, 2);
  std::vector<Table> tables(surface.lobes().tables().begin(), surface.lobes().tables().end());
  tables[1].name = "map_weight1";
  const FactoredBrdf lobes(3, std::move(tables),
                           {surface.lobes().lobes().begin(), surface.lobes().lobes().end()});
  EXPECT_THAT([&] { format_surface_exr({.brdf = SpatialBrdf(lobes, surface.maps()), .notes = "{}"}); },
              ThrowsMessage<Error>(HasSubstr("map_weight1")));
  // what would be written again by a call for each level
  const std::string deep = R"({"a":)" + std::string(200'000, '[') + std::string(200'000, ']') + "}",
                    notes = R"({"a":")" + std::string(deep.size() - 8, 'x') + R"("})";
  std::string bytes = format_surface_exr({.brdf = surface, .notes = notes});
  bytes.replace(bytes.find(notes), notes.size(), deep);
  EXPECT_THAT([&] { parse_surface(memory_file(bytes)); }, ThrowsMessage<Error>(HasSubstr("deep")));
}

TEST(SurfaceFile, EveryTruncatedFileThrows) {
  for (const std::string& bytes : {seed(), exr_seed()})
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_THROW(parse_surface(memory_file(bytes.substr(0, length))), Error) << length;
  EXPECT_THROW(parse_surface(memory_file(seed() + '\0')), Error);
}

class DamagedSurface : public testing::TestWithParam<bool> {};

TEST_P(DamagedSurface, ThrowsOrIsSound) {
  const std::string bytes = GetParam() ? exr_seed() : seed();
  std::array<double, 3> f;
  std::size_t thrown = 0;
  const std::size_t step = BURNISH_SANITIZED && GetParam() ? 5 : 1;  // OpenEXR takes sanitizers long
  for (std::size_t at = 0; at < bytes.size(); at += step)
    for (const char damage : {'\0', '\xff', '\x1b', '9'}) {
      std::string damaged = bytes;
      damaged[at] = damage;
      try {
        const SurfaceModel surface = parse_surface(memory_file(damaged));
        surface.brdf.eval(0.3, 0.6, 0.4, {0.6, 0, 0.8}, {0, -0.6, 0.8},
                          std::span(f).first(surface.brdf.channels()));
        for (const double value : f) EXPECT_TRUE(std::isfinite(value) && value >= 0) << at;
      } catch (const Error& error) {
        ++thrown;
        EXPECT_THAT(error.what(), HasSubstr("expected")) << at;
      }
    }
  EXPECT_GT(thrown, bytes.size() / step / 4);
}
INSTANTIATE_TEST_SUITE_P(SurfaceFile, DamagedSurface, testing::Bool());

}  // namespace
}  // namespace burnish
