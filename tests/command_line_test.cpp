// The command line is one language.

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/io/open_source.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

/// What it says on both streams.
Outcome burnish(const std::string& arguments) {
  return run(fmt::format("'{}' {} 2>&1", BURNISH_CLI, arguments));
}

std::string first_line(const Outcome& outcome) {
  return outcome.output.substr(0, outcome.output.find('\n'));
}

TEST(CommandLine, SaysWhatAMisspeltWordMayHaveMeant) {
  for (const auto& [arguments, meant] :
       {std::pair{"comapre a b", "'compare'"}, std::pair{"fti lambert", "'fit'"},
        std::pair{"specular tabel", "'table'"}, std::pair{"fit lambert -o x --buget 700", "'--budget'"},
        std::pair{"info lambert --jsno", "'--json'"}, std::pair{"hw generate --vectros 3", "'--vectors'"}}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(first_line(outcome), HasSubstr(fmt::format("did you mean {}?", meant)));
  }
  EXPECT_THAT(first_line(burnish("gibberish")), testing::Not(HasSubstr("did you mean")));
  for (const char* model : {"ggxx", "beckman:alpha_x=0.1", "lambertt"}) {
    const Outcome outcome = burnish(fmt::format("info {}", model));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.output,
                HasSubstr("expected a file or an analytic model, found neither; did you mean"));
  }
}

TEST(CommandLine, KeepsErrorsShort) {
  const TemporaryFolder folder("short_errors");
  const std::string digits(9000, '1');
  for (const std::string& text :
       {R"({"kind":"svd","tables":[)" + digits, R"({"kind":")" + digits + R"(","tables":[],"parameters":{}})",
        "{\"lookupTable\":" + digits + "}", "theta_i,phi_i," + digits + "\n", std::string(5000, '{')}) {
    write(folder.path / "damaged", text);
    const Outcome outcome = burnish(fmt::format("info '{}'", (folder.path / "damaged").string()));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_LT(first_line(outcome).size(), 310u) << outcome.output;  // with the name of the program
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1);
  }
  EXPECT_LT(first_line(burnish(fmt::format("info {}", digits))).size(), 310u);
  EXPECT_LT(first_line(burnish(fmt::format("render lambert --tone {}", digits))).size(), 310u);
}

TEST(CommandLine, WritesWhereItIsToldTo) {
  const TemporaryFolder folder("output_option");
  const std::string out = folder.path.string();
  for (const std::string& arguments : {fmt::format("convert lambert -o '{}/a.csv' --count 5", out),
                                       fmt::format("convert lambert --output '{}/a.csv' --count 5", out),
                                       fmt::format("convert lambert '{}/a.csv' --count 5", out),
                                       fmt::format("measure lambert -o '{}/a.csv' --count 5", out),
                                       fmt::format("specular table --output '{}/a.csv' --count 5", out),
                                       fmt::format("specular table --out '{}/a.csv' --count 5", out)}) {
    std::filesystem::remove(folder.path / "a.csv");
    EXPECT_EQ(burnish(arguments).status, 0) << arguments;
    EXPECT_TRUE(std::filesystem::exists(folder.path / "a.csv")) << arguments;
  }
  EXPECT_EQ(burnish("convert lambert").status, 2);
  EXPECT_EQ(burnish(fmt::format("convert lambert '{0}/b.csv' -o '{0}/c.csv'", out)).status, 2);
}

TEST(CommandLine, PrintsJsonForPrograms) {
  const TemporaryFolder folder("json");
  const std::string out = folder.path.string();
  write(folder.path / "d.csv", seeds::kDirections);
  const auto json = [&](const std::string& arguments) {
    const Outcome outcome = run(fmt::format("'{}' {} --json 2>/dev/null", BURNISH_CLI, arguments));
    EXPECT_EQ(outcome.status, 0) << arguments;
    return nlohmann::json::parse(outcome.output);
  };
  EXPECT_EQ(json(fmt::format("convert ggx '{}/g.csv' --count 7", out))["format"], "csv");
  EXPECT_EQ(json(fmt::format("measure ggx -o '{}/m.csv' --count 7", out))["samples"], 7);
  EXPECT_EQ(json(fmt::format("eval ggx '{0}/d.csv' -o '{0}/v.csv'", out))["pairs"], 2);
  EXPECT_EQ(json("info lambert")["format"], "analytic");
  EXPECT_EQ(json(fmt::format("export phong:exponent=9 --to glsl -o '{}/e'", out))["output"], out + "/e");
  EXPECT_GT(json("help formats").size(), 15u);
}

TEST(CommandLine, ExplainsItsFormatsAndItself) {
  const Outcome formats = burnish("help formats");
  EXPECT_EQ(formats.status, 0);
  for (const char* name : {"UTIA", "OpenMATERIAL", "tensor tree", "ALTA", "Speos"})
    EXPECT_THAT(formats.output, HasSubstr(name));
  EXPECT_THAT(burnish("help fit").output, HasSubstr("--budget"));
  EXPECT_EQ(burnish("help nonsense").status, 2);
  const Outcome version = burnish("--version");
  EXPECT_EQ(version.status, 0);
  for (const char* said : {"burnish ", "instruction sets", "threads", "CLI11 2", "OpenEXR 3", "zstd 1"})
    EXPECT_THAT(version.output, HasSubstr(said));
}

TEST(CommandLine, TakesTheLightOfSpectraFromAName) {
  const TemporaryFolder folder("illuminants");
  const std::string out = folder.path.string();
  write(folder.path / "c.brdf", seeds::kCornell);
  write(folder.path / "light.txt", "# nm power\n380 1\n780 1\n");
  const auto converted = [&](const std::string& light) {
    EXPECT_EQ(burnish(fmt::format("convert '{0}/c.brdf' '{0}/c.csv' --illuminant {1}", out, light)).status,
              0);
    return read(folder.path / "c.csv");
  };
  EXPECT_NE(converted("D50"), converted("D65"));
  EXPECT_NE(converted("A"), converted("E"));
  // equal energy from a file; its rows are other breaks of the same sum
  const Source named = parse_source(memory_file(converted("E")), {});
  const Source given = parse_source(memory_file(converted(out + "/light.txt")), {});
  for (std::size_t i = 0; i < named.samples()->values.size(); ++i)
    EXPECT_NEAR(named.samples()->values[i], given.samples()->values[i], 1e-6);
  EXPECT_EQ(burnish(fmt::format("info '{0}/c.brdf' --illuminant none", out)).status, 1);
}

}  // namespace
}  // namespace burnish
