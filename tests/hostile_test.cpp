// SPDX-License-Identifier: Apache-2.0
// These tests check that bad input of every kind gets one clear error and leaves no output.

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <burnish/io/formats.h>
#include <burnish/io/open_source.h>
#include <burnish/math/random.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

/// Parses the content and returns true if that threw. Any exception but a clear Error fails the test.
bool throws_clearly(std::string_view content) {
  try {
    parse_source(memory_file(content), {});
  } catch (const Error& error) {
    const std::string_view message = error.what();
    EXPECT_EQ(message.find('\n'), std::string_view::npos) << message;
    EXPECT_NE(message.find("expected"), std::string_view::npos) << message;
    EXPECT_NE(message.find("test.file"), std::string_view::npos) << message;
    return true;
  }
  return false;
}

/// Returns the seeds of binary formats, or those of text formats.
std::vector<std::pair<std::string, std::string>> seeds_that(bool are_binary) {
  std::vector<std::pair<std::string, std::string>> result;
  for (auto& seed : seeds::all_seeds())
    if ((binary_format_of(memory_file(seed.second)) != nullptr) == are_binary)
      result.push_back(std::move(seed));
  EXPECT_GT(result.size(), 4u);
  return result;
}

TEST(Hostile, SeedsAreValid) {
  for (const auto& [name, bytes] : seeds::all_seeds())
    EXPECT_NO_THROW(parse_source(memory_file(bytes), {})) << name;
}

TEST(Hostile, EveryTruncatedBinaryFileThrows) {
  // The MBSDF seed has two blocks; cut at the end of the first it is a whole file.
  for (const auto& [name, bytes] : seeds_that(true)) {
    std::size_t whole = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length)
      if (!throws_clearly(bytes.substr(0, length))) ++whole;
    EXPECT_EQ(whole, name == "mbsdf" ? 1u : 0u) << name;
  }
}

// A text cut at the end of a row or of a number's digits is another valid text.
TEST(Hostile, TruncatedTextThrowsOrHasLess) {
  for (const auto& [name, bytes] : seeds_that(false)) {
    const std::uint64_t whole = parse_source(memory_file(bytes), {}).findings.sample_count;
    std::size_t thrown = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const std::string cut = bytes.substr(0, length);
      if (throws_clearly(cut))
        ++thrown;
      else
        EXPECT_LE(parse_source(memory_file(cut), {}).findings.sample_count, whole);
    }
    EXPECT_GT(thrown, bytes.size() / 2) << name;
  }
}

TEST(Hostile, DamagedBytesThrowClearlyOrGiveSoundValues) {
  std::vector<double> f;
  for (const auto& [name, bytes] : seeds::all_seeds())
    for (std::size_t at = 0; at<bytes.size(); at += bytes.size()> 2000 ? 7 : 1)
      for (const char damage : {'\0', '\xff', '-', '9', 'n'}) {
        std::string damaged = bytes;
        damaged[at] = damage;
        if (throws_clearly(damaged)) continue;
        const Source source = parse_source(memory_file(damaged), {});
        f.resize(source.ref().channels());
        source.ref().eval({0.6, 0, 0.8}, {0, -0.6, 0.8}, f);
        for (const double value : f) EXPECT_TRUE(std::isfinite(value)) << name << " damaged at " << at;
      }
}

// A UTIA file has a fixed length, so this one file is large and few of its bytes are tried.
TEST(Hostile, UtiaCutOrDamagedThrowsClearlyOrGivesSoundValues) {
  constexpr std::size_t kNumbers = 3 * 288 * 288;
  std::string whole;
  for (std::size_t i = 0; i < kNumbers; ++i) whole += seeds::kUtia;
  EXPECT_FALSE(throws_clearly(whole));
  for (const std::size_t length :
       {0ul, 1ul, 8ul, whole.size() / 3, whole.size() / 2, whole.size() - 8, whole.size() - 1})
    EXPECT_TRUE(throws_clearly(std::string_view(whole).substr(0, length))) << length;
  EXPECT_TRUE(throws_clearly(whole + '\0'));

  std::vector<double> f(3);
  Pcg32 random(1);
  for (int i = 0; i < 20; ++i) {
    // This byte has a number's sign and exponent. Damage makes the number huge or NaN, tiny or negative.
    const std::size_t at = random.next() % kNumbers * 8 + 7;
    const char damage = "\xff\x7f\0-n\xbf"[i % 6];
    std::string damaged = whole;
    damaged[at] = damage;
    const bool beyond = damage == '\xff' || damage == '\x7f' || damage == 'n';
    EXPECT_EQ(throws_clearly(damaged), beyond) << at << ": " << static_cast<int>(damage);
    if (beyond) continue;
    parse_source(memory_file(damaged), {}).ref().eval({0.6, 0, 0.8}, {0, -0.6, 0.8}, f);
    for (const double value : f) EXPECT_TRUE(std::isfinite(value)) << at;
  }
}

TEST(Hostile, NoiseThrows) {
  Pcg32 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string noise(random.next() % 400, '\0');
    for (char& c : noise) c = static_cast<char>(random.next());
    EXPECT_TRUE(throws_clearly(noise));
  }
}

TEST(Hostile, LyingSizesThrowBeforeAnythingIsAllocated) {
  const auto words = [](std::initializer_list<std::uint32_t> values) {
    std::string bytes;
    for (const std::uint32_t value : values) seeds::append(bytes, value);
    return bytes;
  };
  const std::string big_endian_merl = words({0x5a000000, 0x5a000000, 0xb4000000}) + std::string(1000, '\0');
  const std::string huge_merl = words({3600, 3600, 3600}) + std::string(1000, '\0');
  const std::string negative_merl = words({0xffffffff, 90, 180}) + std::string(1000, '\0');
  const std::string mbsdf = "NVIDIA ARC MBSDF V1\nMBSDF_DATA_REFLECTION=\n";
  for (const std::string& bytes :
       {big_endian_merl, huge_merl, negative_merl, mbsdf + words({1, 2000, 2000}),
        mbsdf + words({1, 0xffffffff, 2}), mbsdf + words({1, 0, 0}), std::string("1000\n400 410\n"),
        std::string("999999999999999999999\n400\n"), std::string("-3\n400\n"),
        std::string("tensor_file\0\1\0\xff\xff\xff\xff", 18)})
    EXPECT_TRUE(throws_clearly(bytes));
}

class HostileCommandLine : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              fmt::format("burnish_{}_{}", testing::UnitTest::GetInstance()->current_test_info()->name(),
                          ::getpid());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name, std::string_view content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  /// Runs burnish and returns its standard error as the output.
  static Outcome run_burnish(const std::string& arguments) {
    return run(fmt::format("'{}' {} 2>&1 >/dev/null", BURNISH_CLI, arguments));
  }

  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(HostileCommandLine, SaysOneLineAndLeavesNoOutput) {
  for (const auto& [name, bytes] : seeds::all_seeds()) {
    const fs::path cut = file(name, bytes.substr(0, bytes.size() / 3));
    for (const char* verb : {"info '{}'", "convert '{}' '{}/out.csv'", "measure '{}' -o '{}/out.csv'"}) {
      const Outcome outcome = run_burnish(fmt::format(fmt::runtime(verb), cut.string(), folder_.string()));
      EXPECT_EQ(outcome.status, 1) << name << ": " << outcome.output;
      EXPECT_THAT(outcome.output, StartsWith("burnish: ")) << name;
      EXPECT_THAT(outcome.output, HasSubstr(cut.string()));
      EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
      EXPECT_EQ(file_count(), 1u) << name;
    }
    fs::remove(cut);
  }
}

TEST_F(HostileCommandLine, FailsOnMissingEmptyAndUnwritableFiles) {
  EXPECT_EQ(run_burnish(fmt::format("info '{}/none'", folder_.string())).status, 1);
  EXPECT_EQ(run_burnish(fmt::format("info '{}'", folder_.string())).status, 1);
  EXPECT_EQ(run_burnish(fmt::format("info '{}'", file("empty", "").string())).status, 1);
  EXPECT_EQ(run_burnish(fmt::format("measure lambert -o '{}/none/out.csv'", folder_.string())).status, 1);
  EXPECT_EQ(run_burnish(fmt::format("convert lambert '{}/out.csv' --entries", folder_.string())).status, 1);
  EXPECT_EQ(run_burnish(fmt::format("convert lambert '{}/out.unknown'", folder_.string())).status, 2);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(HostileCommandLine, TellsMisuseFromBadInput) {
  EXPECT_EQ(run_burnish("").status, 2);
  EXPECT_EQ(run_burnish("nonsense").status, 2);
  EXPECT_EQ(run_burnish("info").status, 2);
  EXPECT_EQ(run_burnish("measure lambert").status, 2);
  EXPECT_EQ(run_burnish("measure lambert -o x.csv --noise -1").status, 2);
  EXPECT_EQ(run_burnish("measure lambert -o x.csv --seed -1").status, 2);
  EXPECT_EQ(run_burnish("info --help").status, 0);
  EXPECT_EQ(run_burnish("--version").status, 0);
}

TEST_F(HostileCommandLine, ConvertsWhatIsWell) {
  const std::string out = folder_.string();
  EXPECT_EQ(run_burnish(fmt::format("measure ggx -o '{}/m.csv' --count 200 --noise 0.1", out)).status, 0);
  EXPECT_EQ(run_burnish(fmt::format("convert '{0}/m.csv' '{0}/m2.csv'", out)).status, 0);
  EXPECT_EQ(run_burnish(fmt::format("convert lambert '{0}/l.bsdf'", out)).status, 0);
  EXPECT_EQ(run_burnish(fmt::format("info --json '{0}/l.bsdf'", out)).status, 0);
  EXPECT_EQ(run_burnish(fmt::format("fit ggx --method dgf --budget 600 -o '{}/d.json'", out)).status, 0);
  EXPECT_EQ(run_burnish(fmt::format("fit ggx --method analytic:ward -o '{}/w.json' --json", out)).status, 0);
  EXPECT_EQ(run_burnish(fmt::format("compare ggx '{0}/d.json' '{0}/w.json' --count 100", out)).status, 0);
  EXPECT_EQ(open_source(out + "/d.json", {}).findings.format, "dgf baseline");
  EXPECT_EQ(run_burnish(fmt::format("fit ggx --method pca -o '{}/p.json'", out)).status, 1);
  const Outcome averaged =
      run_burnish(fmt::format("convert ggx:alpha_x=0.1,alpha_y=0.4 '{0}/a.binary' --cells 10", out));
  EXPECT_EQ(averaged.status, 0);
  EXPECT_THAT(averaged.output, HasSubstr("burnish: a.binary: lost: anisotropy averaged"));
  EXPECT_THAT(averaged.output, HasSubstr("\nburnish: a.binary: warning: The values are "));
  EXPECT_EQ(std::count(averaged.output.begin(), averaged.output.end(), '\n'), 2) << averaged.output;
  std::vector<std::string> formats = {"rgb9e5"};
  if (!BURNISH_SANITIZED) formats.insert(formats.end(), {"half", "float", "unorm8"});  // each is a fit
  for (const std::string& format : formats)
    EXPECT_EQ(
        run_burnish(
            fmt::format("fit ggx:kd=0.3/0.2/0.1 --budget 600 --format {} --conserve-energy --loss relative "
                        "-o '{}/b.exr'",
                        format, out))
            .status,
        0);
  EXPECT_LE(open_source(out + "/b.exr", {}).bytes().value(), 600u);
  EXPECT_EQ(run_burnish(fmt::format("fit ggx --budget 10 -o '{}/b.exr'", out)).status, 1);
  const Source back = open_source(out + "/m2.csv", {});
  EXPECT_EQ(back.samples()->size(), 200u);
  EXPECT_TRUE(back.ref().isotropic());
}

}  // namespace
}  // namespace burnish
