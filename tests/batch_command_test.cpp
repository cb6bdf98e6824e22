// SPDX-License-Identifier: Apache-2.0
// These tests run `burnish batch` as a program: exit codes, messages, and the script for Slurm.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using testing::Not;

class BatchCommand : public testing::Test {
 protected:
  BatchCommand() {
    write(folder_.path / "a list",
          "ggx:alpha_x=0.3,alpha_y=0.3\nmissing.csv\nward:alpha_x=0.2,alpha_y=0.2\n");
  }
  Outcome batch(const std::string& arguments) const {
    return run(fmt::format("cd {} && {} batch {}", folder_.path.string(), BURNISH_CLI, arguments));
  }
  static constexpr const char* kQuick = " --model pqp --table p=8x8 --table q=9x9 --samples 500";
  TemporaryFolder folder_{"batch_command"};
};

TEST_F(BatchCommand, SaysAtTheEndWhatFailedAndHasTheRest) {
  const Outcome outcome = batch(std::string("'a list' -o out") + kQuick);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("fitted     2 of 3 materials"));
  EXPECT_THAT(outcome.output, HasSubstr("failed     missing: missing.csv"));
  EXPECT_THAT(outcome.output,
              HasSubstr("burnish: 1 of 3 materials were not fitted; all other materials were\n"));
  // The batch writes the same bits as the fit alone.
  ASSERT_EQ(run(fmt::format("{} fit ggx:alpha_x=0.3,alpha_y=0.3 -o {}{}", BURNISH_CLI,
                            (folder_.path / "alone.burnish").string(), kQuick))
                .status,
            0);
  EXPECT_EQ(read(folder_.path / "out/models/ggx_alpha_x_0.3_alpha_y_0.3.burnish"),
            read(folder_.path / "alone.burnish"));

  EXPECT_THAT(batch(std::string("'a list' -o out") + kQuick).output, HasSubstr("to resume it"));
  const Outcome again = batch(std::string("'a list' -o out --resume --json 2> /dev/null") + kQuick);
  EXPECT_EQ(again.status, 1);
  const auto json = nlohmann::json::parse(again.output);
  EXPECT_EQ(json["materials"], 3);
  EXPECT_EQ(json["earlier"], 2);
  EXPECT_EQ(json["failures"][0]["name"], "missing");
}

TEST_F(BatchCommand, DoesNotTakeItsOwnResultsForMaterials) {
  std::filesystem::create_directory(folder_.path / "meas");
  write(folder_.path / "meas/felt.csv",
        "theta_i,phi_i,theta_o,phi_o,value\n5,0,12,0,0.3\n22,0,11,60,0.2\n40,0,17,60,0.25\n");
  ASSERT_EQ(batch(std::string("meas -o meas/library") + kQuick).status, 0);
  for (const char* const out : {"meas/library --resume", "other"}) {
    const Outcome again = batch(std::string("meas --json -o ") + out + kQuick);
    ASSERT_EQ(again.status, 0) << again.output;
    EXPECT_EQ(nlohmann::json::parse(again.output)["materials"], 1) << out;
  }
  EXPECT_THAT(batch("meas -o meas").output, HasSubstr("meas: expected a folder with measurements"));
}

TEST_F(BatchCommand, SkipsWhatIsNoMeasurementInADownloadedFolder) {
  std::filesystem::create_directory(folder_.path / "downloaded");
  write(folder_.path / "downloaded/README.txt", "Paints, measured in May.\n");
  write(folder_.path / "downloaded/felt.csv",
        "theta_i,phi_i,theta_o,phi_o,value\n5,0,12,0,0.3\n22,0,11,60,0.2\n40,0,17,60,0.25\n");
  const Outcome outcome = batch(std::string("downloaded -o out") + kQuick);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("fitted     1 of 1 materials"));
  EXPECT_THAT(outcome.output, HasSubstr("skipped    1 file that is no measurement: README.txt\n"));
  const Outcome json = batch(std::string("downloaded -o other --json") + kQuick);
  EXPECT_EQ(nlohmann::json::parse(json.output)["skipped"].size(), 1u);
  // A file named in a list must be fitted, and so must a broken measurement.
  write(folder_.path / "named", "downloaded/README.txt\n");
  EXPECT_EQ(batch(std::string("named -o third") + kQuick).status, 1);
  write(folder_.path / "downloaded/cut.binary", "abc");
  EXPECT_EQ(batch(std::string("downloaded -o fourth") + kQuick).status, 1);
}

TEST_F(BatchCommand, TakesTheOptionsOfAFitAndRefusesWhatContradictsItself) {
  EXPECT_EQ(batch("'a list' -o out --method svd --budget auto").status, 2);
  EXPECT_EQ(batch("'a list' -o out --method svd --to glsl").status, 2);
  EXPECT_EQ(batch("'a list' -o out --mips").status, 2);
  EXPECT_EQ(batch("'a list'").status, 2);
  EXPECT_THAT(batch("nowhere -o out").output, HasSubstr("nowhere: expected a readable file"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path / "out"));
}

TEST_F(BatchCommand, WritesAJobArrayThatRunsTheSameCommand) {
  const Outcome outcome =
      batch(std::string("'a list' -o 'an out' --slurm --tasks 7 --sbatch=--partition=long "
                        "--threads 2 --memory 1G --keep-negatives") +
            kQuick);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const std::string script = read(folder_.path / "an out/batch.slurm");
  EXPECT_THAT(script, HasSubstr("#SBATCH --array=1-7\n"));
  EXPECT_THAT(script, HasSubstr("#SBATCH --cpus-per-task=2\n"));
  EXPECT_THAT(script, HasSubstr("#SBATCH --mem=1280M\n"));
  EXPECT_THAT(script, HasSubstr("#SBATCH --partition=long\n"));
  EXPECT_THAT(script, Not(HasSubstr("--slurm ")));

  // A shell that runs the script does the same as the command.
  EXPECT_EQ(run(fmt::format("cd {} && bash 'an out/batch.slurm'", folder_.path.string())).status, 1);
  ASSERT_EQ(batch(std::string("'a list' -o out --keep-negatives") + kQuick).status, 1);
  const std::string model = "models/ward_alpha_x_0.2_alpha_y_0.2.burnish";
  EXPECT_EQ(read(folder_.path / "an out" / model), read(folder_.path / "out" / model));
}

TEST_F(BatchCommand, WritesNoLinesIntoTheJobArrayThatNobodyAskedFor) {
  const Outcome option = batch("'a list' -o out --slurm --sbatch='--x\nrm -rf /'");
  EXPECT_EQ(option.status, 2);
  EXPECT_THAT(option.output,
              HasSubstr("expected an option without control characters, found '--x rm -rf /'"));
  const Outcome folder = batch("'a list' -o 'out\nput' --slurm");
  EXPECT_EQ(folder.status, 1);
  EXPECT_THAT(folder.output, HasSubstr("expected words and paths without control characters"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path / "out"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path / "out\nput"));
}

TEST_F(BatchCommand, SaysAsJsonWhereTheJobArrayIs) {
  const auto json = nlohmann::json::parse(batch("'a list' -o out --slurm --tasks 3 --json").output);
  EXPECT_EQ(json["script"], "out/batch.slurm");
  EXPECT_EQ(json["materials"], 3);
  EXPECT_EQ(json["tasks"], 3);
}

}  // namespace
}  // namespace burnish
