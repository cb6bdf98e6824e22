// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/io/merl.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

/// Returns a MERL file of `sizes` whose stored value is 1500 in every channel.
FileBytes constant_file(std::array<std::int32_t, 3> sizes) {
  const auto entries = static_cast<std::size_t>(sizes[0] * sizes[1] * sizes[2]);
  FileBytes file{"test.binary", std::vector<std::byte>(12 + entries * 24)};
  std::memcpy(file.bytes.data(), sizes.data(), 12);
  const double value = 1500;
  for (std::size_t i = 0; i < 3 * entries; ++i) std::memcpy(file.bytes.data() + 12 + 8 * i, &value, 8);
  return file;
}

void store(FileBytes& file, std::size_t index, double value) {
  std::memcpy(file.bytes.data() + 12 + 8 * index, &value, 8);
}

struct Glossy {
  std::size_t channels() const noexcept { return 3; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const double c = half_vector(wi, wo).z;
    for (std::size_t i = 0; i < 3; ++i) f[i] = 0.1 * static_cast<double>(i + 1) + std::pow(c, 8);
    return wi.z > 0 && wo.z > 0;
  }
};

TEST(Merl, ScalesTheThreePlanes) {
  const MerlFile merl = parse_merl(constant_file({4, 5, 6}));
  std::array<double, 3> f;
  ASSERT_TRUE(merl.table.eval({0, 0, 1}, {0, 0, 1}, f));
  EXPECT_FLOAT_EQ(static_cast<float>(f[0]), 1);
  EXPECT_FLOAT_EQ(static_cast<float>(f[1]), 1.15f);
  EXPECT_FLOAT_EQ(static_cast<float>(f[2]), 1.66f);
  EXPECT_EQ(merl.findings.sample_count, 120u);
  EXPECT_GT(merl.findings.hole_count, 0u);  // below the horizon
}

TEST(Merl, HonoursThePhiDCountOfTheHeader) {
  EXPECT_FALSE(parse_merl(constant_file({3, 3, 180})).table.full_circle);
  EXPECT_TRUE(parse_merl(constant_file({3, 3, 360})).table.full_circle);
}

TEST(Merl, TakesMinusOneAsAHoleAndKeepsOtherNegatives) {
  FileBytes file = constant_file({2, 2, 2});
  for (std::size_t c = 0; c < 3; ++c) store(file, 8 * c, -1);
  store(file, 1, -3);
  const MerlFile merl = parse_merl(file);
  EXPECT_TRUE(std::isnan(merl.table.values[0]));
  EXPECT_EQ(merl.findings.negative_count, 1u);
  EXPECT_DOUBLE_EQ(merl.findings.most_negative, -3 / 1500.0);
  EXPECT_FLOAT_EQ(merl.table.values[3], -3 / 1500.0f);
}

TEST(Merl, AcceptsJunkBelowTheHorizonOnly) {
  FileBytes file = constant_file({8, 8, 8});
  const std::size_t last = 8 * 8 * 8 - 8;  // largest theta_h and theta_d, smallest phi_d
  store(file, last, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(parse_merl(file).table.values[3 * last]));
  store(file, 0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(parse_merl(file), Error);
  store(file, 0, 1e300);
  EXPECT_THROW(parse_merl(file), Error);
}

TEST(Merl, RefusesSizesThatDoNotFitTheFile) {
  FileBytes file = constant_file({4, 4, 4});
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{4}, std::size_t{11}, std::size_t{12}, file.bytes.size() - 1}) {
    FileBytes cut{file.name, {file.bytes.begin(), file.bytes.begin() + static_cast<std::ptrdiff_t>(length)}};
    EXPECT_THROW(parse_merl(cut), Error) << length;
  }
  file.bytes.push_back(std::byte{0});
  EXPECT_THROW(parse_merl(file), Error);
  for (const std::int32_t bad : {0, -90, 1 << 30, 0x5a000000}) {
    FileBytes lying = constant_file({4, 4, 4});
    std::memcpy(lying.bytes.data(), &bad, 4);
    EXPECT_THROW(parse_merl(lying), Error) << bad;
  }
}

TEST(Merl, RoundTripsASource) {
  const TemporaryFolder folder("merl");
  const auto path = folder.path / "round_trip.binary";
  const Glossy source;
  write_merl(path, source);
  EXPECT_EQ(std::filesystem::file_size(path), 12 + 90 * 90 * 180 * 3 * 8u);
  const MerlFile merl = parse_merl(read_file(path));
  std::array<double, 3> f, truth;
  for (const auto& [wi, wo] : draw_pairs(5000, 1, true)) {
    ASSERT_TRUE(merl.table.eval(wi, wo, f));
    source.eval(wi, wo, truth);
    // The bound is the curvature of pow(cos, 8) over one cell: 1/8 (pi/2 / 45)^2 8.
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], truth[c], 1.3e-3);
  }
}

TEST(Merl, WritesTablesOfAnySize) {
  for (const bool full : {false, true}) {
    const HalfDiffTable table = tabulate_half_diff(Glossy{}, 3, 4, full ? 360 : 6, full);
    const std::string bytes = format_merl(table);
    const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
    const HalfDiffTable back = parse_merl({"test.binary", {data, data + bytes.size()}}).table;
    EXPECT_EQ(back.full_circle, full);
    ASSERT_EQ(back.values.size(), table.values.size());
    for (std::size_t i = 0; i < table.values.size(); ++i)
      if (std::isnan(table.values[i])) {
        EXPECT_TRUE(std::isnan(back.values[i]));
      } else {
        EXPECT_EQ(back.values[i], table.values[i]);
      }
  }
  EXPECT_THROW(format_merl(tabulate_half_diff(Glossy{}, 3, 4, 12, true)), Error);
}

TEST(Merl, WritesWhatItReadsAsFloats) {
  FileBytes file = constant_file({2, 2, 2});
  Pcg32 random(3);
  for (std::size_t i = 0; i < 24; ++i) store(file, i, 1e4 * random.uniform() - 100);
  const HalfDiffTable read = parse_merl(file).table;
  const std::string again = format_merl(read);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    if (std::isnan(read.values[i % 8 * 3])) continue;  // below the horizon
    double before, after;
    std::memcpy(&before, file.bytes.data() + 12 + 8 * i, 8);
    std::memcpy(&after, again.data() + 12 + 8 * i, 8);
    EXPECT_NEAR(after, before, 0x1p-24 * std::abs(before));
    ++kept;
  }
  EXPECT_GT(kept, 0u);
}

TEST(Merl, NamesTheFileItCannotWrite) {
  struct Brushed : Glossy {
    bool isotropic() const noexcept { return false; }
  };
  try {
    write_merl("some.binary", Brushed{});
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("some.binary: expected an isotropic source"));
  }
}

}  // namespace
}  // namespace burnish
