// SPDX-License-Identifier: Apache-2.0
// These tests check that `burnish fit` writes and prints the library's results.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/fitting/fit_file.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/io/open_source.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

constexpr const char* kPaint = "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5/0.3/0.1,kd=0.2";
// Angles are in degrees, values in 1/sr.
constexpr const char* kScattered =
    "theta_i,phi_i,theta_o,phi_o,value\n5,0,12,0,0.3\n22,0,11,60,0.2\n40,0,17,60,0.25\n50,0,50,180,0.5\n"
    "11,0,62,110,0.2\n28,0,29,175,0.6\n62,0,23,50,0.2\n";

class FitCommand : public testing::Test {
 protected:
  // Runs the command with --json; it writes `out()`.
  Outcome run_fit(const std::string& source, const std::string& arguments) const {
    return run(fmt::format("{} fit '{}' -o {} --json {}", BURNISH_CLI, source, out(), arguments));
  }
  std::string out() const { return (folder_.path / "out").string(); }
  std::string scattered() const {
    const auto path = folder_.path / "scattered.csv";
    write(path, kScattered);
    return path.string();
  }

  const std::filesystem::path& folder() const { return folder_.path; }

  void expect_same(const std::string& source, const std::string& arguments, const FitOptions& options) {
    const Outcome outcome = run_fit(source, arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const Fit made = fit(open_source(source, {}), options);
    EXPECT_EQ(read(out()), format_fit(made)) << arguments;
    auto expected = nlohmann::json::parse(summary_json(made, out(), 0, read(out()).size())),
         found = nlohmann::json::parse(outcome.output);
    expected.erase("seconds");
    found.erase("seconds");
    EXPECT_EQ(found, expected) << arguments;
  }

 private:
  TemporaryFolder folder_{"fit_command"};
};

TEST_F(FitCommand, WritesTheFileThatTheNameAsksFor) {
  const std::string name = out() + ".burnish", command = std::string(BURNISH_CLI) + ' ';
  ASSERT_EQ(run(command + "fit " + kPaint + " --model pqp --table q=9 --samples 2000 -o " + name).status, 0);
  const Model model = to_model(open_source(name, {}));
  EXPECT_EQ(read(name), format_model_as(name, model));
  // A model with a name in .exr becomes its other file. Slices need --to exr.
  EXPECT_EQ(run(command + "convert " + name + ' ' + out() + ".exr").status, 0);
  EXPECT_EQ(read(out() + ".exr"), format_model(model));
  EXPECT_EQ(run(command + "convert " + name + ' ' + out() + ".exr --to exr --cells 4").status, 0);
  EXPECT_THROW(open_source(out() + ".exr", {}), Error);
}

TEST_F(FitCommand, ToAMaterialIsTheLibrarysFit) {
  const Outcome outcome = run_fit(kPaint, "--to gltf --alone");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const MaterialFit made = fit_material(open_source(kPaint, {}), "gltf", {.beside = false});
  EXPECT_EQ(read(out()), format_material(made));
  const Outcome taken = run(fmt::format("{} info {} 2>&1", BURNISH_CLI, out()));
  EXPECT_EQ(taken.status, 1);
  EXPECT_EQ(taken.output,
            fmt::format("burnish: {}: expected a measurement, baseline or model, found a material "
                        "of glTF, which only programs that read glTF take\n",
                        out()));
  auto expected = nlohmann::json::parse(summary_json(made, out())),
       found = nlohmann::json::parse(outcome.output);
  expected.erase("seconds");
  found.erase("seconds");
  EXPECT_EQ(found, expected);
}

TEST_F(FitCommand, ToAMaterialNeedsNoFileAndSaysWhatIsBeyondIt) {
  // This BRDF reflects more towards the light than elsewhere.
  const std::string command =
      std::string(BURNISH_CLI) + " fit lafortune:cx=0.9,cy=0.9,cz=0.9,ks=0.5 --alone --to gltf";
  const Outcome outcome = run(command);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, testing::HasSubstr("base colour"));
  EXPECT_THAT(outcome.output, testing::HasSubstr("beyond     backscatter"));
  for (const std::string with : {"--budget 100", "--model pqp", "--conserve-energy", "--no-symmetrize"}) {
    const Outcome refused = run(command + " " + with);
    EXPECT_EQ(refused.status, 2) << with;
    EXPECT_THAT(refused.output, testing::HasSubstr("--to excludes " + with.substr(0, with.find(' '))));
  }
  const Outcome misspelt = run(std::string(BURNISH_CLI) + " fit ggx --to opnpbr");
  EXPECT_EQ(misspelt.status, 2);
  EXPECT_THAT(misspelt.output, testing::HasSubstr("openpbr"));
  EXPECT_EQ(run(std::string(BURNISH_CLI) + " fit ggx").status, 2);  // factors need a file
}

TEST_F(FitCommand, IsOfAModelOrWithinABudget) {
  for (const char* form : {" --model pqp", " --table q=24"}) {
    const Outcome outcome = run(std::string(BURNISH_CLI) + " fit ggx --budget 2700 -o " + out() + form);
    EXPECT_EQ(outcome.status, 2) << form;
    EXPECT_THAT(outcome.output, testing::HasSubstr("excludes"));
  }
}

TEST_F(FitCommand, IsTheLibrarysFit) {
  BURNISH_SKIP_WHERE_SANITIZED();
  expect_same(
      kPaint, "--model pqpr --table q=24 --floor 1e-4 --reweightings 1 --samples 3000 --seed 4",
      {.form = OneLobe{.model = "pqpr", .tables = {"q=24"}, .how = {.reweightings = 1, .floor = 1e-4}},
       .samples = 3000,
       .seed = 4});
  expect_same(kPaint, "--model pqp --smooth auto --samples 2000 --no-symmetrize",
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
  expect_same(kPaint, "--budget auto --loss log_cos",
              {.form = Budget{.bytes = {}, .loss = FitLoss::log_cos}});
  expect_same(kPaint, "--method nd --budget 400", {.form = BaselineMethod{"nd", 400}});
  const std::string samples = scattered();
  expect_same(samples, "", {});
  expect_same(samples, "--budget 300", {.form = Budget{.bytes = 300}});
}

TEST_F(FitCommand, FollowsNodesOrTheFunctionAndComparePrintsBoth) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const std::string file = (folder() / "paint.bsdf").string();
  ASSERT_EQ(run(fmt::format("{} convert {} {}", BURNISH_CLI, kPaint, file)).status, 0);
  const FitForm form = Budget{.bytes = 700};
  expect_same(file, "--budget 700 --target function", {.form = form, .target = FitTarget::function});
  expect_same(file, "--budget 700", {.form = form});
  expect_same(file, "--budget 700 --target nodes", {.form = form, .target = FitTarget::nodes});
  expect_same(file, "--budget 700 --hold-out half=1", {.form = form, .hold_out = parse_node_part("half=1")});

  const std::string compare = fmt::format("{} compare {} {} --count 1000", BURNISH_CLI, file, out());
  const std::string nodes = "at the measured nodes", model = "psnr";
  const std::string both = run(compare).output;
  EXPECT_THAT(both, testing::AllOf(testing::HasSubstr(nodes), testing::HasSubstr(model)));
  const std::string function = run(compare + " --target function").output;
  EXPECT_THAT(function, testing::AllOf(testing::Not(testing::HasSubstr(nodes)), testing::HasSubstr(model)));
  const std::string at_nodes = run(compare + " --target nodes").output;
  EXPECT_THAT(at_nodes, testing::AllOf(testing::HasSubstr(nodes), testing::Not(testing::HasSubstr(model))));
}

TEST_F(FitCommand, TellsMisuseFromErrors) {
  EXPECT_EQ(run_fit(kPaint, "--model 'p(up)'").status, 2);
  EXPECT_EQ(run_fit(kPaint, "--smooth much").status, 2);
  EXPECT_EQ(run_fit(kPaint, "--lobes 2").status, 2);
  EXPECT_EQ(run_fit(kPaint, "--method svd --format half").status, 2);
  EXPECT_EQ(run_fit(kPaint, "--method svd --model pqp").status, 2);
  EXPECT_EQ(run_fit(kPaint, "--target function --hold-out half=1").status, 2);
  for (const char* bytes : {"much", "-5", "0", "16Q", "4G"}) {
    const Outcome outcome = run_fit(kPaint, fmt::format("--budget {}", bytes));
    EXPECT_EQ(outcome.status, 2) << bytes;
    EXPECT_NE(outcome.output.find(fmt::format("found '{}'", bytes)), std::string::npos) << outcome.output;
  }
  EXPECT_EQ(run_fit(kPaint, "--method pca").status, 1);
  EXPECT_EQ(run_fit(kPaint, "--book '" + scattered() + "'").status, 1);
  EXPECT_EQ(run_fit(kPaint, "--budget 20").status, 1);
}

}  // namespace
}  // namespace burnish
