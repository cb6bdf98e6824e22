// `burnish fit` writes and prints what the library gives.

#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include <burnish/fitting/fit_file.h>
#include <burnish/io/open_source.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

constexpr const char* kPaint = "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5/0.3/0.1,kd=0.2";
// Angles in degrees, values in 1/sr.
constexpr const char* kScattered =
    "theta_i,phi_i,theta_o,phi_o,value\n5,0,12,0,0.3\n22,0,11,60,0.2\n40,0,17,60,0.25\n50,0,50,180,0.5\n"
    "11,0,62,110,0.2\n28,0,29,175,0.6\n62,0,23,50,0.2\n";

class FitCommand : public testing::Test {
 protected:
  // The exit code of the command with --json, which writes `written()` and prints `printed()`.
  int run(const std::string& source, const std::string& arguments) const {
    return WEXITSTATUS(std::system(fmt::format("{} fit '{}' -o {} --json {} > {} 2> {}", BURNISH_CLI, source,
                                               out(), arguments, (folder_.path / "printed").string(),
                                               (folder_.path / "said").string())
                                       .c_str()));
  }
  std::string out() const { return (folder_.path / "out").string(); }
  std::string written() const { return read(out()); }
  std::string printed() const { return read(folder_.path / "printed"); }
  std::string said() const { return read(folder_.path / "said"); }
  std::string scattered() const {
    const auto path = folder_.path / "scattered.csv";
    write(path, kScattered);
    return path.string();
  }

  void expect_same(const std::string& source, const std::string& arguments, const FitOptions& options) {
    ASSERT_EQ(run(source, arguments), 0) << said();
    const Fit made = fit(open_source(source, {}), options);
    EXPECT_EQ(written(), format_fit(made)) << arguments;
    auto expected = nlohmann::json::parse(summary_json(made, out(), 0)),
         found = nlohmann::json::parse(printed());
    expected.erase("seconds");
    found.erase("seconds");
    EXPECT_EQ(found, expected) << arguments;
  }

 private:
  TemporaryFolder folder_{"fit_command"};
};

TEST_F(FitCommand, IsTheLibrarysFit) {
  expect_same(kPaint, "", {});
  expect_same(
      kPaint, "--model pqpr --table q=24 --floor 1e-4 --reweightings 1 --samples 3000 --seed 4",
      {.form = OneLobe{.model = "pqpr", .tables = {"q=24"}, .how = {.reweightings = 1, .floor = 1e-4}},
       .samples = 3000,
       .seed = 4});
  expect_same(kPaint, "--smooth auto --samples 2000 --no-symmetrize",
              {.form = OneLobe{.how = {.cross_validate = true}}, .samples = 2000, .symmetrize = false});
  expect_same(kPaint, "--budget 300 --loss relative --format half --smooth 1e-6 --conserve-energy",
              {.form = Budget{.bytes = 300, .loss = FitLoss::relative},
               .smooth = 1e-6,
               .format = TableFormat::half,
               .conserve_energy = true});
  expect_same(kPaint, "--model 'p(wo) q(h) p(wi) + s(h)' --table s=6 --loss log_cos",
              {.form = GivenLobes{"p(wo) q(h) p(wi) + s(h)", {"s=6"}, FitLoss::log_cos}});
  expect_same(kPaint, "--method analytic:cook-torrance --samples 2000",
              {.form = BaselineMethod{"analytic:cook-torrance"}, .samples = 2000});
  expect_same(kPaint, "--method nd --budget 400", {.form = BaselineMethod{"nd", 400}});
  const std::string samples = scattered();
  expect_same(samples, "", {});
  expect_same(samples, "--budget 300", {.form = Budget{.bytes = 300}});
}

TEST_F(FitCommand, TellsMisuseFromErrors) {
  EXPECT_EQ(run(kPaint, "--model 'p(up)'"), 2);
  EXPECT_EQ(run(kPaint, "--smooth much"), 2);
  EXPECT_EQ(run(kPaint, "--lobes 2"), 2);
  EXPECT_EQ(run(kPaint, "--method pca"), 1);
  EXPECT_EQ(run(kPaint, "--method svd --format half"), 1);
  EXPECT_EQ(run(kPaint, "--budget 20"), 1);
}

}  // namespace
}  // namespace burnish
