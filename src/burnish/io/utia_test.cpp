// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>
#include <burnish/io/utia.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::HasSubstr;

constexpr std::size_t kDirections = 288, kPlane = kDirections * kDirections;

std::vector<double> random_numbers() {
  Pcg32 random(1);
  std::vector<double> stored(3 * kPlane);
  for (double& v : stored) v = 60 * random.uniform() * random.uniform() - 0.5;
  return stored;
}

std::string bytes_of(const std::vector<double>& stored) {
  return {reinterpret_cast<const char*>(stored.data()), stored.size() * sizeof(double)};
}

// Returns the value at a node by the lines of dj_brdf.h: its index, its scale and its curve.
double dj_brdf(const std::vector<double>& stored, std::size_t plane, std::size_t iti, std::size_t ipi,
               std::size_t itv, std::size_t ipv) {
  const std::size_t nc = 48 * 6, nr = 48 * 6;
  const double v = stored[plane * nr * nc + nc * (48 * iti + ipi) + 48 * itv + ipv] / 140.0;
  return 100 * (v > 0.0375 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92);
}

TEST(Utia, HasTheValuesThatDjBrdfHas) {
  const std::vector<double> stored = random_numbers();
  const std::string bytes = bytes_of(stored);
  EXPECT_TRUE(looks_like_utia(memory_file(bytes).bytes));
  const UtiaFile file = parse_utia(memory_file(bytes));
  EXPECT_EQ(file.findings.sample_count, kPlane);
  EXPECT_GT(file.findings.negative_count, 0u);
  std::vector<double> f(3);
  for (std::size_t entry = 0; entry < kPlane; entry += 101) {
    const std::size_t ipv = entry % 48, itv = entry / 48 % 6, ipi = entry / 288 % 48, iti = entry / 288 / 48;
    const auto direction = [](std::size_t theta, std::size_t phi) {
      // The directions lie off the normal, where every azimuth is the same.
      return spherical_direction(std::max(radians(15.0 * static_cast<double>(theta)), 1e-9),
                                 radians(7.5 * static_cast<double>(phi)));
    };
    ASSERT_TRUE(file.table.eval_raw(direction(iti, ipi), direction(itv, ipv), f));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], dj_brdf(stored, c, iti, ipi, itv, ipv), 1e-4);
  }
}

TEST(Utia, IsConstantFromTheLastAngleToTheHorizon) {
  const UtiaFile file = parse_utia(memory_file(bytes_of(random_numbers())));
  std::vector<double> last(3), beyond(3);
  const Vec3 wi = spherical_direction(radians(30), 1);
  ASSERT_TRUE(file.table.eval_raw(wi, spherical_direction(radians(75), 2), last));
  ASSERT_TRUE(file.table.eval_raw(wi, spherical_direction(radians(89.99), 2), beyond));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(last[c], beyond[c], 1e-6);
}

TEST(Utia, IsWrittenAsItWasRead) {
  std::vector<double> stored = random_numbers();
  stored[0] = 5.25;  // values on both sides of the curve's knee
  stored[1] = std::nextafter(5.25, 6);
  stored[2] = 5.25 * (1 + 1e-9);
  const AngleTable read = parse_utia(memory_file(bytes_of(stored))).table;
  const std::string again = format_utia(read);
  ASSERT_EQ(again.size(), bytes_of(stored).size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    double v;
    std::memcpy(&v, again.data() + i * sizeof(double), sizeof(double));
    EXPECT_NEAR(v, stored[i], 1.1 * 0x1p-24 * std::abs(stored[i]));
  }
  EXPECT_EQ(parse_utia(memory_file(again)).table.values, read.values);
}

TEST(Utia, MovesWhatNoStoredValueStandsFor) {
  AngleTable table = utia_layout();
  for (std::size_t i = 0; i < 3 * kPlane; ++i)
    table.values.push_back(0.2902F + 0.0002F * static_cast<float>(i) / (3 * kPlane));
  const AngleTable back = parse_utia(memory_file(format_utia(table))).table;
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const bool between = table.values[i] > 0.29024 && table.values[i] < 0.29036;
    EXPECT_NEAR(back.values[i], table.values[i], between ? 6e-5 : 0);
  }
}

TEST(Utia, HoldsOtherSourcesAtItsNodes) {
  const Source source = open_source("ggx:alpha_x=0.5,alpha_y=0.7", {});
  const Source back = parse_source(memory_file(convert(source, "utia", {}).bytes), {});
  EXPECT_EQ(back.findings.format, "UTIA table");
  const auto& table = std::get<AngleTable>(back.brdf);
  std::vector<double> f(3), g(3);
  for (std::size_t entry = 0; entry < kPlane; entry += 37) {
    const auto [wi, wo] = node_directions(table, node_of_entry(table, entry));
    source.ref().eval(wi, wo, f);
    back.ref().eval(wi, wo, g);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g[c], f[c], 2e-6 * (1 + f[c])) << entry;
  }
  EXPECT_EQ(convert(open_source("lambert", {}), "utia", {}).bytes.size(), 3 * kPlane * sizeof(double));
}

TEST(Utia, IsKnownByItsLengthAndNumbers) {
  std::string text(3 * kPlane * sizeof(double), ' ');
  EXPECT_FALSE(looks_like_utia(memory_file(text).bytes));
  std::string whole = bytes_of(random_numbers());
  EXPECT_FALSE(looks_like_utia(memory_file(whole.substr(8)).bytes));
  const double infinite = INFINITY;
  std::memcpy(whole.data() + 800, &infinite, sizeof(infinite));
  EXPECT_THAT(error_of([&] { parse_source(memory_file(whole), {}); }),
              HasSubstr("offset 800: expected a finite"));
  EXPECT_THAT(error_of([&] { parse_utia(memory_file("short")); }), HasSubstr("1990656 bytes"));
  // The fuzzer's seed is read too.
  std::string seed;
  while (seed.size() < whole.size()) seed += seeds::kUtia;
  EXPECT_NO_THROW(parse_utia(memory_file(seed)));
}

}  // namespace
}  // namespace burnish
